#include "tum_recording/image_size.hpp"

#include "tum_recording/png_decoder.hpp"

namespace stillpoint::tum_recording {
namespace {

int big_endian(std::uint8_t high, std::uint8_t low) { return high << 8 | low; }

/// Segments of a marker and a length follow each other up to the frame header (ITU-T T.81, B.2.2).
std::optional<cv::Size> size_of_jpeg(std::span<const std::uint8_t> file) {
  for (std::size_t at = 2; at + 9 <= file.size();) {
    if (file[at] != 0xff) return std::nullopt;
    const std::uint8_t marker = file[at + 1];
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    const bool table = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    if (marker >= 0xc0 && marker <= 0xcf && !table)
      return cv::Size(big_endian(file[at + 7], file[at + 8]),
                      big_endian(file[at + 5], file[at + 6]));
    at += 2 + static_cast<std::size_t>(big_endian(file[at + 2], file[at + 3]));
  }
  return std::nullopt;
}

}  // namespace

std::optional<cv::Size> stated_size(std::span<const std::uint8_t> file) {
  if (PngDecoder::is_png(file)) return PngDecoder::stated_size(file);
  if (file.size() > 2 && file[0] == 0xff && file[1] == 0xd8) return size_of_jpeg(file);
  return std::nullopt;
}

}  // namespace stillpoint::tum_recording
