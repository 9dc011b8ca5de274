#include "tum_recording/image_decoder.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"

namespace stillpoint::tum_recording {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& problem,
                       const std::string& remedy = {}) {
  throw Error(Fault::kData, problem, where, remedy);
}

std::string kind_of(const cv::Mat& image) {
  const int bits = static_cast<int>(8 * image.elemSize1());
  return std::to_string(bits) + "-bit image with " + std::to_string(image.channels()) +
         (image.channels() == 1 ? " channel" : " channels");
}

}  // namespace

// In compressed data 0xff is always escaped, so that the end-of-image marker cannot appear there by
// chance.
bool is_truncated_jpeg(std::span<const std::uint8_t> file) {
  if (file.size() < 2 || file[0] != 0xff || file[1] != 0xd8) return false;
  constexpr std::uint8_t kEndOfImage[] = {0xff, 0xd9};
  const auto tail = file.last(std::min<std::size_t>(file.size(), 4096));
  return std::search(tail.begin(), tail.end(), std::begin(kEndOfImage), std::end(kEndOfImage)) ==
         tail.end();
}

cv::Mat ImageDecoder::decode(std::span<const std::uint8_t> file, const std::string& where,
                             int imread_flags) {
  require_image_size(file, where);
  cv::Mat image;
  try {
    if (PngDecoder::is_png(file)) image = png_.decode(file);
  } catch (const std::runtime_error& error) {
    fail(where, error.what());
  }
  if (is_truncated_jpeg(file)) fail(where, "truncated JPEG");
  try {
    if (image.empty()) image = decode_image(file, imread_flags);
  } catch (const cv::Exception& error) {
    fail(where, "cannot be decoded: " + error.err);
  }
  if (image.empty()) fail(where, "is not an image that OpenCV can read");
  return image;
}

cv::Mat ImageDecoder::color(std::span<const std::uint8_t> file, const std::string& where) {
  cv::Mat image = decode(file, where, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (image.depth() != CV_8U)
    fail(where, "a colour image must have 8 bits per channel, this is a " + kind_of(image),
         "check that colour and depth are not exchanged");
  if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  return image;
}

cv::Mat ImageDecoder::depth(std::span<const std::uint8_t> file, const std::string& where) {
  cv::Mat image = decode(file, where, cv::IMREAD_UNCHANGED);
  if (image.type() != CV_16UC1)
    fail(where, "a depth image must be 16-bit with 1 channel, this is an " + kind_of(image),
         "check that colour and depth are not exchanged");
  return image;
}

}  // namespace stillpoint::tum_recording
