// Decodes the image files that recordings hold.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

#include "tum_recording/png_decoder.hpp"

namespace stillpoint::tum_recording {

/// A JPEG file without an end, of which a decoder makes a whole image all the same: libjpeg fills
/// what is missing with gray and only warns.
bool is_truncated_jpeg(std::span<const std::uint8_t> file);

/// Throws Error(kData) with `where` and the reason when an image is truncated, damaged or of the
/// wrong kind. One per thread. Files are less than 2 GiB.
class ImageDecoder {
 public:
  /// CV_8UC3 in BGR order; gray images are accepted.
  cv::Mat color(std::span<const std::uint8_t> file, const std::string& where);
  /// CV_16UC1 as stored.
  cv::Mat depth(std::span<const std::uint8_t> file, const std::string& where);

 private:
  cv::Mat decode(std::span<const std::uint8_t> file, const std::string& where, int imread_flags);

  PngDecoder png_;
};

}  // namespace stillpoint::tum_recording
