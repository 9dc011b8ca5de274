#include "image_pixels.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <stillpoint/error.hpp>

namespace stillpoint_ros {
namespace {

/// Rows of `bytes` with four bytes of padding each.
sensor_msgs::Image message(const std::string& encoding, std::uint32_t width, std::uint32_t height,
                           const std::vector<std::uint8_t>& bytes) {
  sensor_msgs::Image image;
  image.encoding = encoding;
  image.width = width;
  image.height = height;
  const std::size_t row = bytes.size() / height;
  image.step = static_cast<std::uint32_t>(row + 4);
  for (std::size_t y = 0; y < height; ++y) {
    image.data.insert(image.data.end(), bytes.begin() + static_cast<std::ptrdiff_t>(y * row),
                      bytes.begin() + static_cast<std::ptrdiff_t>((y + 1) * row));
    image.data.insert(image.data.end(), {77, 77, 77, 77});
  }
  return image;
}

cv::Vec3b last_pixel(const sensor_msgs::Image& image) {
  const cv::Mat bgr = color_pixels(image);
  EXPECT_EQ(bgr.size(), cv::Size(1, 2));
  return bgr.at<cv::Vec3b>(1, 0);
}

TEST(ColorPixels, AreBgrWhateverTheEncoding) {
  EXPECT_EQ(last_pixel(message("bgr8", 1, 2, {0, 0, 0, 1, 2, 3})), cv::Vec3b(1, 2, 3));
  EXPECT_EQ(last_pixel(message("rgb8", 1, 2, {0, 0, 0, 1, 2, 3})), cv::Vec3b(3, 2, 1));
  EXPECT_EQ(last_pixel(message("bgra8", 1, 2, {0, 0, 0, 0, 1, 2, 3, 4})), cv::Vec3b(1, 2, 3));
  EXPECT_EQ(last_pixel(message("rgba8", 1, 2, {0, 0, 0, 0, 1, 2, 3, 4})), cv::Vec3b(3, 2, 1));
  EXPECT_EQ(last_pixel(message("mono8", 1, 2, {0, 9})), cv::Vec3b(9, 9, 9));
}

TEST(ColorPixels, OfAnotherEncodingAreRefusedByName) {
  try {
    color_pixels(message("yuv422", 1, 1, {1, 2}));
    FAIL();
  } catch (const stillpoint::Error& error) {
    EXPECT_NE(std::string(error.what()).find("'yuv422'"), std::string::npos);
  }
}

TEST(DepthPixels, AreAsSentInTheByteOrderOfThisMachine) {
  sensor_msgs::Image image = message("16UC1", 2, 1, {0x01, 0x02, 0x03, 0x04});
  EXPECT_EQ(depth_pixels(image).at<std::uint16_t>(0, 1), 0x0403);
  image.is_bigendian = 1;
  EXPECT_EQ(depth_pixels(image).at<std::uint16_t>(0, 1), 0x0304);
  const float metres = 1.5f;
  std::vector<std::uint8_t> bytes(sizeof(metres));
  std::memcpy(bytes.data(), &metres, sizeof(metres));
  EXPECT_EQ(depth_pixels(message("32FC1", 1, 1, bytes)).at<float>(0, 0), metres);
  EXPECT_THROW(depth_pixels(message("8UC1", 2, 1, {1, 2})), stillpoint::Error);
}

TEST(Pixels, OfNumbersThatDoNotFitTheBytesAreRefused) {
  sensor_msgs::Image image = message("bgr8", 1, 2, {0, 0, 0, 1, 2, 3});
  for (const auto& spoil : std::vector<std::function<void(sensor_msgs::Image&)>>{
           [](auto& its) { its.data.resize(9); }, [](auto& its) { its.height = 3; },
           [](auto& its) { its.width = 3; }, [](auto& its) { its.step = 2; },
           [](auto& its) { its.width = 0; }, [](auto& its) { its.height = 0xffffffffu; },
           [](auto& its) { its.step = 0xffffffffu; }}) {
    sensor_msgs::Image spoilt = image;
    spoil(spoilt);
    EXPECT_THROW(color_pixels(spoilt), stillpoint::Error);
  }
  image = message("16UC1", 2, 1, {1, 2, 3, 4});
  image.step = 5;
  EXPECT_THROW(depth_pixels(image), stillpoint::Error);
}

}  // namespace
}  // namespace stillpoint_ros
