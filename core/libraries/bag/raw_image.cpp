#include "bag/raw_image.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace stillpoint::bag {
namespace {

constexpr int kNoConversion = -1;
constexpr int kLargestSide = 16384;  // px, as of a camera

struct ColorEncoding {
  const char* name;
  int type;
  int conversion;
};

// OpenCV names Bayer patterns by the second row, ROS by the first.
constexpr ColorEncoding kColorEncodings[] = {
    {"bgr8", CV_8UC3, kNoConversion},
    {"8UC3", CV_8UC3, kNoConversion},
    {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    {"mono8", CV_8UC1, cv::COLOR_GRAY2BGR},
    {"8UC1", CV_8UC1, cv::COLOR_GRAY2BGR},
    {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    {"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
};

bool is_png(ByteSpan file) {
  constexpr std::uint8_t kMagic[] = {0x89, 'P', 'N', 'G'};
  return file.size() >= std::size(kMagic) &&
         std::equal(std::begin(kMagic), std::end(kMagic), file.begin());
}

[[noreturn]] void refuse(const std::string& problem) { throw Error(Fault::kData, problem); }

/// The message's own bytes as a matrix.
cv::Mat view_of(const ImageMessage& image, int type) {
  const ImageDescription& is = image.description;
  if (is.width < 1 || is.height < 1 || is.width > kLargestSide || is.height > kLargestSide)
    refuse("an image of " + std::to_string(is.width) + " x " + std::to_string(is.height) +
           " pixels comes from no camera");
  const std::size_t row = static_cast<std::size_t>(is.width) * CV_ELEM_SIZE(type);
  const std::size_t step = std::max(image.step, row);
  if (image.step < row || image.data.size() < step * static_cast<std::size_t>(is.height - 1) + row)
    refuse("the image has fewer bytes than its size and encoding ask for");
  if (step % CV_ELEM_SIZE1(type) != 0)
    refuse("rows of " + std::to_string(step) + " bytes do not fit the encoding");
  return {is.height, is.width, type, const_cast<std::uint8_t*>(image.data.data()), step};
}

void swap_bytes(cv::Mat& image) {
  const std::size_t size = image.elemSize();
  for (int y = 0; y < image.rows; ++y) {
    std::uint8_t* row = image.ptr(y);
    for (int x = 0; x < image.cols; ++x) std::reverse(row + x * size, row + (x + 1) * size);
  }
}

}  // namespace

cv::Mat color_pixels(const ImageMessage& image) {
  const std::string& encoding = image.description.encoding;
  const auto* known = std::ranges::find_if(
      kColorEncodings, [&](const ColorEncoding& its) { return encoding == its.name; });
  if (known == std::end(kColorEncodings))
    refuse("a colour image cannot have the encoding '" + encoding + "'");
  const cv::Mat recorded = view_of(image, known->type);
  if (known->conversion == kNoConversion) return recorded.clone();
  try {
    cv::Mat bgr;
    cv::cvtColor(recorded, bgr, known->conversion);
    return bgr;
  } catch (const cv::Exception& error) {  // YUV of an odd width
    refuse("cannot be converted: " + error.err);
  }
}

cv::Mat depth_pixels(const ImageMessage& image) {
  const std::string& encoding = image.description.encoding;
  const bool metres = encoding == "32FC1";
  if (!metres && encoding != "16UC1" && encoding != "mono16")
    refuse("a depth image cannot have the encoding '" + encoding + "'");
  cv::Mat depth = view_of(image, metres ? CV_32FC1 : CV_16UC1).clone();
  if (image.big_endian != (std::endian::native == std::endian::big)) swap_bytes(depth);
  return depth;
}

CompressedDepth compressed_depth(const ImageMessage& image) {
  constexpr std::size_t kHeader = 12;  // bytes: kind, two numbers
  const std::string& format = image.description.encoding;
  if (is_png(image.data)) return {.png = image.data, .inverse_header = {}};
  if (image.data.size() < kHeader || !is_png(image.data.subspan(kHeader)))
    refuse("depth of the format '" + format + "' is read as PNG only, which this is not");
  const bool inverse = format.starts_with("32FC1");
  return {.png = image.data.subspan(kHeader),
          .inverse_header = inverse ? image.data.first(kHeader) : ByteSpan()};
}

cv::Mat metres_of_inverse_depth(const cv::Mat& quantised, ByteSpan header) {
  ByteReader reader(header);
  reader.skip(4);  // its format
  const auto a = reader.number<float>();
  const auto b = reader.number<float>();
  cv::Mat metres(quantised.size(), CV_32FC1);
  for (int y = 0; y < metres.rows; ++y)
    for (int x = 0; x < metres.cols; ++x) {
      const auto raw = quantised.at<std::uint16_t>(y, x);
      metres.at<float>(y, x) = raw == 0 ? 0.0F : a / (static_cast<float>(raw) - b);
    }
  return metres;
}

}  // namespace stillpoint::bag
