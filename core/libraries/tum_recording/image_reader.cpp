#include "tum_recording/image_reader.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>

#include "stillpoint/error.hpp"
#include "stillpoint/support/size_text.hpp"
#include "tum_recording/image_size.hpp"

namespace stillpoint::tum_recording {
namespace {

constexpr std::uintmax_t kLargestFile = 256 << 20;  // bytes
constexpr std::int64_t kMostPixels = 100'000'000;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem,
                       const std::string& remedy = {}) {
  throw Error(Fault::kData, problem, file.string(), remedy);
}

/// libjpeg fills what a truncated file lacks with gray and only warns. In compressed data 0xff is
/// always escaped, so that the end-of-image marker cannot appear there by chance.
bool is_truncated_jpeg(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2 || bytes[0] != 0xff || bytes[1] != 0xd8) return false;
  constexpr std::uint8_t kEndOfImage[] = {0xff, 0xd9};
  const auto tail = bytes.last(std::min<std::size_t>(bytes.size(), 4096));
  return std::search(tail.begin(), tail.end(), std::begin(kEndOfImage), std::end(kEndOfImage)) ==
         tail.end();
}

std::string kind_of(const cv::Mat& image) {
  const int bits = static_cast<int>(8 * image.elemSize1());
  return std::to_string(bits) + "-bit image with " + std::to_string(image.channels()) +
         (image.channels() == 1 ? " channel" : " channels");
}

}  // namespace

void ImageReader::load(const std::filesystem::path& file) {
  std::error_code error;
  // A pipe would be waited for.
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    fail(file, "is no regular file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(
      std::fopen(file.c_str(), "rb"), [](std::FILE* f) { return std::fclose(f); });
  if (!stream)
    fail(file, std::filesystem::exists(file, error) ? "cannot be opened" : "no such file");
  const auto size = std::filesystem::file_size(file, error);
  if (error) fail(file, "cannot be read: " + error.message());
  if (size == 0) fail(file, "the file is empty");
  if (size > kLargestFile) fail(file, "is larger than 256 MiB: no image of a camera");
  bytes_.resize(size);
  if (std::fread(bytes_.data(), 1, size, stream.get()) != size) fail(file, "cannot be read");
}

cv::Mat ImageReader::decode(const std::filesystem::path& file, int imread_flags) {
  load(file);
  if (const auto size = stated_size(bytes_);
      size && std::int64_t{size->width} * size->height > kMostPixels)
    fail(file, "an image of " + size_text(*size) + " pixels is more than any camera gives");
  cv::Mat image;
  try {
    if (PngDecoder::is_png(bytes_)) image = png_.decode(bytes_);
  } catch (const std::runtime_error& error) {
    fail(file, error.what());
  }
  if (is_truncated_jpeg(bytes_)) fail(file, "truncated JPEG");
  try {
    if (image.empty()) image = cv::imdecode(bytes_, imread_flags);
  } catch (const cv::Exception& error) {
    fail(file, "cannot be decoded: " + error.err);
  }
  if (image.empty()) fail(file, "is not an image that OpenCV can read");
  return image;
}

cv::Mat ImageReader::color(const std::filesystem::path& file) {
  cv::Mat image = decode(file, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (image.depth() != CV_8U)
    fail(file, "a colour image must have 8 bits per channel, this is a " + kind_of(image),
         "check that colour and depth are not exchanged");
  if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  return image;
}

cv::Mat ImageReader::depth(const std::filesystem::path& file) {
  cv::Mat image = decode(file, cv::IMREAD_UNCHANGED);
  if (image.type() != CV_16UC1)
    fail(file, "a depth image must be 16-bit with 1 channel, this is an " + kind_of(image),
         "check that colour and depth are not exchanged");
  return image;
}

}  // namespace stillpoint::tum_recording
