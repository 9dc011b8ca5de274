// Images in files.
#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>

#include "fuzz/fuzz_target.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"
#include "tum_recording/png_decoder.hpp"

namespace stillpoint::testing {
namespace {

using tum_recording::PngDecoder;

void append_number(Bytes& file, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    file.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t number_at(const Bytes& file, std::size_t at) {
  return static_cast<std::uint32_t>(file[at]) << 24 | file[at + 1] << 16 | file[at + 2] << 8 |
         file[at + 3];
}

Bytes encoded(const std::string& kind, int type) {
  cv::Mat image(6, 9, type);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, 256);
  return encode_image(kind, image);
}

constexpr int kMostPixels = 1 << 20;      // ImageReader refuses what is too large
constexpr std::size_t kPngSignature = 8;  // bytes

/// The CRC of every chunk that is whole.
void repair_png(Bytes& file) {
  std::size_t at = kPngSignature;
  while (at + 12 <= file.size()) {
    const std::size_t size = number_at(file, at);
    if (size > file.size() - at - 12) return;
    Bytes crc;
    append_number(crc, libdeflate_crc32(0, &file[at + 4], size + 4));
    std::ranges::copy(crc, file.begin() + static_cast<std::ptrdiff_t>(at + 8 + size));
    at += size + 12;
  }
}

void append_chunk(Bytes& file, std::string_view name, const Bytes& data) {
  append_number(file, static_cast<std::uint32_t>(data.size()));
  file.insert(file.end(), name.begin(), name.end());
  file.insert(file.end(), data.begin(), data.end());
  append_number(file, 0);
}

/// 13 bytes of a header, and what is behind them compressed: what a PNG holds before its filters
/// are undone.
Bytes png_of(const Bytes& parts) {
  constexpr std::size_t kHeader = 13;
  if (parts.size() < kHeader) return parts;
  const std::span<const std::uint8_t> pixels(parts.begin() + kHeader, parts.end());
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(1), libdeflate_free_compressor);
  Bytes data(libdeflate_zlib_compress_bound(compressor.get(), pixels.size()));
  data.resize(libdeflate_zlib_compress(compressor.get(), pixels.data(), pixels.size(), data.data(),
                                       data.size()));
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(file, "IHDR", {parts.begin(), parts.begin() + kHeader});
  append_chunk(file, "IDAT", data);
  append_chunk(file, "IEND", {});
  repair_png(file);
  return file;
}

void decode(const Bytes& png) {
  const auto size = stated_image_size(png);
  if (size && std::int64_t{size->width} * size->height < kMostPixels) PngDecoder().decode(png);
}

FuzzTarget png() {
  return {.seeds = {encoded(".png", CV_8UC1), encoded(".png", CV_8UC3), encoded(".png", CV_16UC1)},
          .parse = [](const fs::path& file) { decode(bytes_of(file)); },
          .repair = repair_png,
          .words = {"IHDR", "IDAT", "IEND", "PLTE", "tRNS"}};
}

FuzzTarget png_pixels() {
  const auto picture = [](std::uint8_t bits, std::uint8_t color) {
    Bytes parts = {0, 0, 0, 4, 0, 0, 0, 3, bits, color, 0, 0, 0};
    const int bytes = 4 * (color == 2 ? 3 : 1) * bits / 8;
    for (std::uint8_t row = 0; row < 3; ++row) {
      parts.push_back(row);
      for (int i = 0; i < bytes; ++i) parts.push_back(static_cast<std::uint8_t>(37 * i));
    }
    return parts;
  };
  return {.seeds = {picture(8, 0), picture(8, 2), picture(16, 0)},
          .parse = [](const fs::path& file) { decode(png_of(bytes_of(file))); }};
}

FuzzTarget image_size() {
  return {.seeds = {encoded(".png", CV_8UC3), encoded(".jpg", CV_8UC3), encoded(".webp", CV_8UC3),
                    encoded(".bmp", CV_8UC3), encoded(".ppm", CV_8UC3)},
          .parse = [](const fs::path& file) { stated_image_size(bytes_of(file)); },
          .words = {"\xff\xd8", "\xff\xc0", "\xff\xe0", "\xff\xff", "VP8X", "VP8L", "#"}};
}

}  // namespace

std::vector<NamedFuzzTarget> image_targets() {
  return {{"Png", png}, {"PngPixels", png_pixels}, {"ImageSize", image_size}};
}

}  // namespace stillpoint::testing
