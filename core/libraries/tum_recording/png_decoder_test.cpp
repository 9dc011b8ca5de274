#include "tum_recording/png_decoder.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "stillpoint/support/image_codec.hpp"

namespace stillpoint::tum_recording {
namespace {

/// Noise above, smooth below: rows of both kinds.
cv::Mat picture(int width, int height, int type) {
  cv::Mat noise(height, width, type), image;
  cv::RNG rng(7);
  rng.fill(noise, cv::RNG::UNIFORM, 0, type == CV_16UC1 ? 65536 : 256);
  cv::GaussianBlur(noise, image, {9, 9}, 3);
  for (int y = 0; y < height / 2; ++y) noise.row(y).copyTo(image.row(y));
  return image;
}

void append_chunk(std::vector<std::uint8_t>& file, const std::string& name,
                  const std::vector<std::uint8_t>& data) {
  const auto append_number = [&](std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
      file.push_back(static_cast<std::uint8_t>(value >> shift));
  };
  append_number(static_cast<std::uint32_t>(data.size()));
  const std::size_t start = file.size();
  file.insert(file.end(), name.begin(), name.end());
  file.insert(file.end(), data.begin(), data.end());
  append_number(libdeflate_crc32(0, &file[start], file.size() - start));
}

/// A PNG of random bytes whose row y uses filter y modulo 5; any bytes are a valid picture.
std::vector<std::uint8_t> file_with_all_filters(int width, int height, int bits, int color) {
  const auto number = [](int value) { return static_cast<std::uint8_t>(value); };
  const int row_size = width * (color == 2 ? 3 : 1) * bits / 8;
  std::vector<std::uint8_t> filtered;
  cv::RNG rng(width);
  for (int y = 0; y < height; ++y) {
    filtered.push_back(number(y % 5));
    for (int i = 0; i < row_size; ++i) filtered.push_back(number(rng.uniform(0, 256)));
  }
  auto* compressor = libdeflate_alloc_compressor(1);
  std::vector<std::uint8_t> data(libdeflate_zlib_compress_bound(compressor, filtered.size()));
  data.resize(libdeflate_zlib_compress(compressor, filtered.data(), filtered.size(), data.data(),
                                       data.size()));
  libdeflate_free_compressor(compressor);

  std::vector<std::uint8_t> file{0x89, 'P', 'N', 'G', 13, 10, 26, 10};
  append_chunk(file, "IHDR",
               {0, 0, number(width >> 8), number(width), 0, 0, number(height >> 8), number(height),
                number(bits), number(color), 0, 0, 0});
  const auto middle = data.begin() + static_cast<std::ptrdiff_t>(data.size() / 2);
  append_chunk(file, "IDAT", {data.begin(), middle});
  append_chunk(file, "IDAT", {middle, data.end()});
  append_chunk(file, "IEND", {});
  return file;
}

std::vector<std::uint8_t> encode(const cv::Mat& image) { return encode_image(".png", image); }

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(PngDecoder, ReturnsThePixelsThatWereEncoded) {
  PngDecoder decoder;
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1})
    for (const cv::Size size : {cv::Size(320, 240), cv::Size(1, 1), cv::Size(65, 2)}) {
      const cv::Mat image = picture(size.width, size.height, type);
      EXPECT_TRUE(equal(decoder.decode(encode(image)), image)) << type << " " << size;
    }
}

TEST(PngDecoder, AgreesWithOpenCvOnEveryFilter) {
  PngDecoder decoder;
  for (const auto& [bits, color] : {std::pair(8, 0), std::pair(8, 2), std::pair(16, 0)})
    for (const int width : {1, 2, 37, 300}) {
      const auto file = file_with_all_filters(width, 25, bits, color);
      EXPECT_TRUE(equal(decoder.decode(file), decode_image(file, cv::IMREAD_UNCHANGED)))
          << bits << " bits, colour type " << color << ", width " << width;
    }
}

TEST(PngDecoder, LeavesOtherKindsToOpenCv) {
  PngDecoder decoder;
  EXPECT_TRUE(decoder.decode(encode(picture(20, 10, CV_8UC4))).empty());
}

TEST(PngDecoder, HasOneSizeAtItsBeginning) {
  PngDecoder decoder;
  const auto large = encode(picture(40, 30, CV_8UC3));
  auto two_sizes = encode(picture(4, 3, CV_8UC3));
  const auto header_end = two_sizes.begin() + 33;  // signature, and IHDR with its 13 bytes
  two_sizes.insert(header_end, large.begin() + 8, large.begin() + 33);
  EXPECT_THROW(decoder.decode(two_sizes), std::runtime_error);
  std::vector<std::uint8_t> late(large.begin(), large.begin() + 8);
  append_chunk(late, "tEXt", {'a'});
  late.insert(late.end(), large.begin() + 8, large.end());
  EXPECT_THROW(decoder.decode(late), std::runtime_error);
}

// A few bytes of pixels can be gigabytes: no more is unpacked than the size at the beginning needs.
TEST(PngDecoder, UnpacksNoMoreAndNoLessThanItsSize) {
  constexpr std::ptrdiff_t kHeader = 33;  // bytes: signature, and IHDR with its 13 bytes
  PngDecoder decoder;
  const auto small = encode(picture(4, 3, CV_8UC1));
  const auto large = encode(cv::Mat::zeros(4000, 4000, CV_8UC1));
  const auto with_pixels_of = [&](const auto& header, const auto& pixels) {
    std::vector<std::uint8_t> file(header.begin(), header.begin() + kHeader);
    file.insert(file.end(), pixels.begin() + kHeader, pixels.end());
    return file;
  };
  EXPECT_THROW(decoder.decode(with_pixels_of(small, large)), std::runtime_error);
  EXPECT_THROW(decoder.decode(with_pixels_of(large, small)), std::runtime_error);
  EXPECT_TRUE(equal(decoder.decode(with_pixels_of(small, small)), picture(4, 3, CV_8UC1)));
}

TEST(PngDecoder, RefusesTruncatedAndDamagedFilesWhereverTheyAreHit) {
  PngDecoder decoder;
  const auto sound = encode(picture(40, 30, CV_8UC3));
  for (std::size_t size = 8; size < sound.size(); size += 7)
    EXPECT_THROW(decoder.decode(std::span(sound).first(size)), std::runtime_error) << size;
  for (std::size_t at = 8; at < sound.size(); at += 5) {
    auto damaged = sound;
    damaged[at] ^= 0x10;
    EXPECT_THROW(decoder.decode(damaged), std::runtime_error) << at;
  }
  EXPECT_TRUE(equal(decoder.decode(sound), picture(40, 30, CV_8UC3)));
}

}  // namespace
}  // namespace stillpoint::tum_recording
