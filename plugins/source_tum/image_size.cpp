#include "source_tum/image_size.hpp"

#include <algorithm>
#include <limits>

#include "source_tum/png_decoder.hpp"

namespace stillpoint {
namespace {

std::uint32_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

int side(std::uint32_t pixels) {
  return static_cast<int>(std::min<std::uint32_t>(pixels, std::numeric_limits<int>::max()));
}

/// The header comes first (PNG specification, 11.2.2).
std::optional<cv::Size> size_of_png(std::span<const std::uint8_t> file) {
  if (file.size() < 24) return std::nullopt;
  return cv::Size(side(big_endian(file.subspan(16, 4))), side(big_endian(file.subspan(20, 4))));
}

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
      return cv::Size(side(big_endian(file.subspan(at + 7, 2))),
                      side(big_endian(file.subspan(at + 5, 2))));
    at += 2 + big_endian(file.subspan(at + 2, 2));
  }
  return std::nullopt;
}

}  // namespace

std::optional<cv::Size> stated_size(std::span<const std::uint8_t> file) {
  if (PngDecoder::is_png(file)) return size_of_png(file);
  if (file.size() > 2 && file[0] == 0xff && file[1] == 0xd8) return size_of_jpeg(file);
  return std::nullopt;
}

}  // namespace stillpoint
