// What the readers of all layouts do with images.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

/// A file that stays as it is. Throws Error(kData) when it is not there.
StoredImage kept_image(double time, const std::filesystem::path& file);

/// A depth image that was changed, as a PNG file.
StoredImage new_depth(double time, const cv::Mat& depth);

/// Throws Error(kData) unless colour, depth and camera have one size; reads the images.
void check_first_pair(const std::filesystem::path& color, const std::filesystem::path& depth,
                      const CameraModel& camera);

/// Throws Error(kData) unless an image has the camera's size; `where` names it.
void check_size(cv::Size size, const CameraModel& camera, const std::string& where);

/// The number in a name such as "000042.png" or "1403636579763555584.png"; nothing for others.
std::optional<std::int64_t> number_of(const std::string& word);

/// Names of files in a folder, sorted.
std::vector<std::string> file_names(const std::filesystem::path& folder);

}  // namespace stillpoint::importing
