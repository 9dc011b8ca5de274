#include "stillpoint/support/image_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string_view>

#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uintmax_t kLargestFile = 256 << 20;  // bytes
constexpr std::int64_t kMostPixels = 100'000'000;
constexpr std::int64_t kLongestSide = std::numeric_limits<int>::max();

bool has_at(Bytes file, std::size_t at, std::string_view text) {
  if (file.size() < at + text.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (file[at + i] != static_cast<std::uint8_t>(text[i])) return false;
  return true;
}

std::int64_t big_endian(Bytes bytes) {
  std::int64_t number = 0;
  for (const std::uint8_t byte : bytes) number = number << 8 | byte;
  return number;
}

std::int64_t little_endian(Bytes bytes) {
  std::int64_t number = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) number = number << 8 | bytes[i];
  return number;
}

cv::Size size_of(std::int64_t width, std::int64_t height) {
  return {static_cast<int>(std::min(width, kLongestSide)),
          static_cast<int>(std::min(height, kLongestSide))};
}

/// The header comes first (PNG specification, 11.2.2).
std::optional<cv::Size> size_of_png(Bytes file) {
  if (file.size() < 24) return std::nullopt;
  return size_of(big_endian(file.subspan(16, 4)), big_endian(file.subspan(20, 4)));
}

/// Segments of a marker and a length follow each other up to the frame header (ITU-T T.81, B.2.2).
/// Between them decoders skip what is no marker; SOI, RSTn and TEM have no length.
std::optional<cv::Size> size_of_jpeg(Bytes file) {
  for (std::size_t at = 2; at + 9 <= file.size();) {
    const std::uint8_t marker = file[at + 1];
    const bool is_marker = file[at] == 0xff && marker != 0 && marker != 0xff;
    const bool has_length = marker != 0x01 && !(marker >= 0xd0 && marker <= 0xd8);
    if (!is_marker || !has_length) {
      ++at;
      continue;
    }
    const bool table = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    if (marker >= 0xc0 && marker <= 0xcf && !table)
      return size_of(big_endian(file.subspan(at + 7, 2)), big_endian(file.subspan(at + 5, 2)));
    if (marker == 0xd9 || marker == 0xda) return std::nullopt;  // end, or scan without frame header
    at += 2 + static_cast<std::size_t>(big_endian(file.subspan(at + 2, 2)));
  }
  return std::nullopt;
}

/// The three kinds of a first chunk (RFC 9649, 2.5 to 2.7).
std::optional<cv::Size> size_of_webp(Bytes file) {
  if (file.size() < 30) return std::nullopt;
  if (has_at(file, 12, "VP8X"))
    return size_of(1 + little_endian(file.subspan(24, 3)), 1 + little_endian(file.subspan(27, 3)));
  if (has_at(file, 12, "VP8L")) {
    const std::int64_t bits = little_endian(file.subspan(21, 4));
    return size_of(1 + (bits & 0x3fff), 1 + (bits >> 14 & 0x3fff));
  }
  if (has_at(file, 12, "VP8 "))
    return size_of(little_endian(file.subspan(26, 2)) & 0x3fff,
                   little_endian(file.subspan(28, 2)) & 0x3fff);
  return std::nullopt;
}

/// A negative height stands for rows from top to bottom. The oldest header has numbers of 16 bits.
std::optional<cv::Size> size_of_bmp(Bytes file) {
  if (file.size() < 26) return std::nullopt;
  if (little_endian(file.subspan(14, 4)) == 12)
    return size_of(little_endian(file.subspan(18, 2)), little_endian(file.subspan(20, 2)));
  const auto side = [&](std::size_t at) {
    return std::abs(std::int64_t{static_cast<std::int32_t>(little_endian(file.subspan(at, 4)))});
  };
  return size_of(side(18), side(22));
}

/// Numbers in plain text after the kind, read as OpenCV reads them: a comment ends with its line,
/// and one byte after a number is passed over whatever it is.
std::optional<cv::Size> size_of_pnm(Bytes file) {
  std::size_t at = 2;
  const auto number = [&]() -> std::int64_t {
    while (at < file.size() && (std::isspace(file[at]) || file[at] == '#'))
      if (file[at++] == '#')
        while (at < file.size() && file[at] != '\n' && file[at] != '\r') ++at;
    std::int64_t value = 0;
    const std::size_t begin = at;
    for (; at < file.size() && std::isdigit(file[at]); ++at)
      value = std::min(10 * value + (file[at] - '0'), kLongestSide);
    if (at == begin) return -1;
    ++at;
    return value;
  };
  const std::int64_t width = number();
  const std::int64_t height = number();
  if (width < 0 || height < 0) return std::nullopt;
  return size_of(width, height);
}

[[noreturn]] void fail(const std::string& where, const std::string& problem,
                       const std::string& remedy = {}) {
  throw Error(Fault::kData, problem, where, remedy);
}

}  // namespace

std::optional<cv::Size> stated_image_size(Bytes file) {
  if (has_at(file, 0, "\x89PNG\r\n\x1a\n")) return size_of_png(file);
  if (has_at(file, 0, "\xff\xd8")) return size_of_jpeg(file);
  if (has_at(file, 0, "RIFF") && has_at(file, 8, "WEBP")) return size_of_webp(file);
  if (has_at(file, 0, "BM")) return size_of_bmp(file);
  if (has_at(file, 0, "P") && file.size() > 2 && file[1] >= '1' && file[1] <= '6')
    return size_of_pnm(file);
  return std::nullopt;
}

void require_image_size(Bytes file, const std::string& where) {
  const auto size = stated_image_size(file);
  if (!size)
    fail(where, "is not an image that can be read",
         "PNG, JPEG, WebP, BMP and PNM can; is it damaged?");
  if (std::int64_t{size->width} * size->height > kMostPixels)
    fail(where, "an image of " + size_text(*size) + " pixels is more than any camera gives");
}

void read_image_file(const std::filesystem::path& file, std::vector<std::uint8_t>& bytes) {
  const std::string where = file.string();
  bytes.resize(input_file_size(file, kLargestFile));
  if (bytes.empty()) fail(where, "the file is empty");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(
      std::fopen(file.c_str(), "rb"), [](std::FILE* f) { return std::fclose(f); });
  if (!stream) fail(where, "cannot be opened");
  if (std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size())
    fail(where, "cannot be read");
  require_image_size(bytes, where);
}

}  // namespace stillpoint
