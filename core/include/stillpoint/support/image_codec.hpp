// Compressed images. OpenCV's module of image files depends on more than a hundred libraries
// (GDAL's), which take a quarter of a second to load: that is done at the first call, so that a
// start does not wait for it.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <string>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// cv::imdecode: empty when OpenCV cannot read it; damaged files can also throw cv::Exception. Any
/// thread. Throws Error(kUsage) when Stillpoint's installation is incomplete.
STILLPOINT_EXPORT cv::Mat decode_image(std::span<const std::uint8_t> file,
                                       int imread_flags = cv::IMREAD_COLOR);

/// cv::imencode, of the kind that the extension names (".png", ".jpg"), never empty. Throws
/// cv::Exception or Error(kUsage) when OpenCV cannot write that kind, or not with these pixels;
/// otherwise as decode_image().
STILLPOINT_EXPORT std::vector<std::uint8_t> encode_image(
    const std::string& extension, const cv::Mat& image,
    const std::vector<int>& imwrite_options = {});

}  // namespace stillpoint
