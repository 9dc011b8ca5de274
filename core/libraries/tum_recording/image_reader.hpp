// Reads the images of a recording from disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "tum_recording/image_decoder.hpp"

namespace stillpoint::tum_recording {

/// Throws Error(kData) naming the file and the reason when an image is missing, truncated, damaged
/// or of the wrong kind. One per thread.
class ImageReader {
 public:
  /// CV_8UC3 in BGR order; gray images are accepted.
  cv::Mat color(const std::filesystem::path& file);
  /// CV_16UC1 as stored.
  cv::Mat depth(const std::filesystem::path& file);

 private:
  ImageDecoder decoder_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace stillpoint::tum_recording
