#include "image_pixels.hpp"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stillpoint/error.hpp>

namespace stillpoint_ros {
namespace {

namespace encodings = sensor_msgs::image_encodings;
using stillpoint::Error;
using stillpoint::Fault;

constexpr std::uint32_t kLargestSide = 16384;  // px
constexpr int kNoConversion = -1;
constexpr bool kBigEndian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;  // of this machine

struct ColorEncoding {
  const std::string& name;
  int type;
  int conversion;
};

const ColorEncoding kColorEncodings[] = {
    {encodings::BGR8, CV_8UC3, kNoConversion},
    {encodings::RGB8, CV_8UC3, cv::COLOR_RGB2BGR},
    {encodings::BGRA8, CV_8UC4, cv::COLOR_BGRA2BGR},
    {encodings::RGBA8, CV_8UC4, cv::COLOR_RGBA2BGR},
    {encodings::MONO8, CV_8UC1, cv::COLOR_GRAY2BGR},
};

[[noreturn]] void refuse_encoding(const std::string& what, const sensor_msgs::Image& image,
                                  const std::string& allowed) {
  throw Error(Fault::kData,
              what + " images with the encoding '" + image.encoding + "' are not read", "",
              "publish " + allowed);
}

/// The message's own bytes as a matrix.
cv::Mat view_of(const sensor_msgs::Image& image, int type) {
  const std::size_t row = std::size_t{image.width} * CV_ELEM_SIZE(type);
  const bool has_size = image.width >= 1 && image.height >= 1 && image.width <= kLargestSide &&
                        image.height <= kLargestSide;
  if (!has_size || image.step < row || image.step % CV_ELEM_SIZE1(type) != 0 ||
      image.data.size() < std::size_t{image.step} * (image.height - 1) + row)
    throw Error(Fault::kData,
                "an image's bytes do not fit its size of " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " px and its encoding '" + image.encoding + "'");
  return {static_cast<int>(image.height), static_cast<int>(image.width), type,
          const_cast<std::uint8_t*>(image.data.data()), image.step};
}

void swap_bytes(cv::Mat& image) {
  const std::size_t size = image.elemSize();
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      std::reverse(image.ptr(y) + x * size, image.ptr(y) + (x + 1) * size);
}

}  // namespace

cv::Mat color_pixels(const sensor_msgs::Image& image) {
  const auto* known = std::find_if(std::begin(kColorEncodings), std::end(kColorEncodings),
                                   [&](const auto& its) { return image.encoding == its.name; });
  if (known == std::end(kColorEncodings))
    refuse_encoding("colour", image,
                    "bgr8, rgb8, bgra8, rgba8 or mono8, or convert with image_proc");
  const cv::Mat sent = view_of(image, known->type);
  if (known->conversion == kNoConversion) return sent.clone();
  cv::Mat bgr;
  cv::cvtColor(sent, bgr, known->conversion);
  return bgr;
}

cv::Mat depth_pixels(const sensor_msgs::Image& image) {
  const bool metres = image.encoding == encodings::TYPE_32FC1;
  if (!metres && image.encoding != encodings::TYPE_16UC1 && image.encoding != encodings::MONO16)
    refuse_encoding("depth", image, "16UC1 or 32FC1");
  cv::Mat depth = view_of(image, metres ? CV_32FC1 : CV_16UC1).clone();
  if ((image.is_bigendian != 0) != kBigEndian) swap_bytes(depth);
  return depth;
}

}  // namespace stillpoint_ros
