// Fast PNG decoding for the kinds of images that recordings hold.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

struct libdeflate_decompressor;

namespace stillpoint::tum_recording {

/// Decodes 8-bit gray, 8-bit RGB and 16-bit gray images that are not interlaced, in half the time
/// of cv::imdecode (libpng and zlib): 2.0 and 0.8 ms for colour and depth of a simulated frame of
/// 640 x 480, where libpng takes 4.3 and 2.3 ms and libspng 0.7 4.3 and 2.5 ms. Keeps its buffers
/// between images; one per thread.
class PngDecoder {
 public:
  PngDecoder();
  ~PngDecoder();

  static bool is_png(std::span<const std::uint8_t> file);

  /// The image as CV_8UC1, CV_8UC3 (BGR) or CV_16UC1; empty when it is a sound file of another kind
  /// (palette, alpha, interlaced …). Throws std::runtime_error with the reason when the file is
  /// no PNG, truncated or damaged.
  cv::Mat decode(std::span<const std::uint8_t> file);

 private:
  struct Header;
  Header collect_chunks(std::span<const std::uint8_t> file);

  struct Deleter {
    void operator()(libdeflate_decompressor* decompressor) const;
  };
  std::unique_ptr<libdeflate_decompressor, Deleter> decompressor_;
  std::vector<std::uint8_t> compressed_;
  std::vector<std::uint8_t> filtered_;
  std::vector<std::uint8_t> rows_[2];  // the current and the previous one, unfiltered
};

}  // namespace stillpoint::tum_recording
