#include "bag/messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "bag/raw_image.hpp"
#include "support/bag_writer.hpp"

namespace stillpoint::bag {
namespace {

using stillpoint::testing::ByteWriter;
using stillpoint::testing::camera_info_message;
using stillpoint::testing::compressed_message;
using stillpoint::testing::image_message;
using stillpoint::testing::transforms_message;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

class MessagesTest : public ::testing::TestWithParam<Serialisation> {};

TEST_P(MessagesTest, HaveTheirFields) {
  cv::Mat pixels(3, 5, CV_8UC3);
  cv::RNG(1).fill(pixels, cv::RNG::UNIFORM, 0, 256);
  const auto bytes = image_message(GetParam(), 1'305'031'102'175'304'000, "/odd", pixels, "bgr8");
  const ImageMessage image = read_image(bytes, GetParam(), false);
  EXPECT_EQ(image.description.header.stamp, 1'305'031'102'175'304'000);
  EXPECT_EQ(image.description.header.frame, "odd");  // without the slash of old times
  EXPECT_EQ(image.description.encoding, "bgr8");
  EXPECT_EQ(cv::norm(color_pixels(image), pixels, cv::NORM_INF), 0);
  EXPECT_EQ(header_of(ByteSpan(bytes).first(24), GetParam()).stamp, image.description.header.stamp);

  const auto file = compressed_message(GetParam(), 5, "frame", "jpeg", {1, 2, 3});
  const ImageMessage compressed_image = read_image(file, GetParam(), true);
  EXPECT_EQ(compressed_image.description.kind(), ImageKind::kColor);
  EXPECT_THAT(compressed_image.data, ElementsAre(1, 2, 3));
}

TEST_P(MessagesTest, CameraInfosHaveTheirNumbers) {
  const auto bytes = camera_info_message(GetParam(), {.distortion = {0.1, 0.2, 0.3, 0.4, 0.5}});
  const CameraInfoMessage info = read_camera_info(bytes, GetParam());
  EXPECT_EQ(info.width, 64);
  EXPECT_EQ(info.height, 48);
  EXPECT_EQ(info.model, "plumb_bob");
  EXPECT_THAT(info.distortion, ElementsAre(0.1, 0.2, 0.3, 0.4, 0.5));
  EXPECT_THAT(info.intrinsics, ElementsAre(50, 0, 32, 0, 51, 24, 0, 0, 1));
  EXPECT_EQ(info.projection[0], 45);
  EXPECT_EQ(info.projection[6], 24);
}

TEST_P(MessagesTest, TransformsHaveTheirFrames) {
  Pose pose(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5));
  pose.translation() = Eigen::Vector3d(1, -2, 0.25);
  Pose scaled = pose;
  scaled.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const auto bytes = transforms_message(
      GetParam(), {{"/base", "/arm", pose}, {"base", "lost", scaled}, {"arm", "hand", pose}});
  const auto transforms = read_transforms(bytes, GetParam());
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_EQ(transforms[0].parent, "base");
  EXPECT_EQ(transforms[0].child, "arm");
  EXPECT_EQ(transforms[1].child, "hand");
  EXPECT_TRUE(transforms[1].parent_from_child.isApprox(pose));
}

TEST_P(MessagesTest, ThatEndTooEarlyAreRefused) {
  const auto image = image_message(GetParam(), 5, "f", cv::Mat::zeros(3, 5, CV_8UC3), "bgr8");
  const auto info = camera_info_message(GetParam());
  for (std::size_t size = 0; size < image.size(); ++size)
    EXPECT_THROW(read_image(ByteSpan(image).first(size), GetParam(), false), Error) << size;
  for (std::size_t size = 0; size < info.size(); ++size)
    EXPECT_THROW(read_camera_info(ByteSpan(info).first(size), GetParam()), Error) << size;
  const auto transforms = transforms_message(GetParam(), {{"a", "b", Pose::Identity()}});
  for (std::size_t size = 0; size < transforms.size(); ++size)
    EXPECT_THROW(read_transforms(ByteSpan(transforms).first(size), GetParam()), Error) << size;
}

INSTANTIATE_TEST_SUITE_P(Serialisations, MessagesTest,
                         ::testing::Values(Serialisation::kRos1, Serialisation::kCdr));

TEST(Cdr, IsReadInBothByteOrders) {
  const std::vector<std::uint8_t> bytes = {0, 0, 0, 0, 0, 1, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8};
  ByteReader reader(bytes, Serialisation::kCdr);
  EXPECT_EQ(reader.number<std::uint16_t>(), 1);
  EXPECT_EQ(reader.number<std::uint32_t>(), 0x01020304U);  // behind two bytes of padding
}

TEST(Cdr, OfOtherVersionsIsRefused) {
  const std::vector<std::uint8_t> bytes = {0, 7, 0, 0, 1, 2, 3, 4};
  EXPECT_THROW(ByteReader(bytes, Serialisation::kCdr), Error);
  EXPECT_THROW(ByteReader(bytes, Serialisation::kOther), Error);
}

ImageMessage image_with(const std::vector<std::uint8_t>& data, int width, int height,
                        const std::string& encoding, std::size_t step) {
  return {.description = {.width = width, .height = height, .encoding = encoding},
          .step = step,
          .data = data};
}

TEST(RawImages, AreConvertedToBgr) {
  const std::vector<std::uint8_t> data = {10, 20, 30, 40, 50, 60, 70, 80};
  const auto first = [&](const std::string& encoding, int width, std::size_t step) {
    return color_pixels(image_with(data, width, 1, encoding, step)).at<cv::Vec3b>(0, 0);
  };
  EXPECT_EQ(first("bgr8", 2, 8), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(first("rgb8", 2, 8), cv::Vec3b(30, 20, 10));
  EXPECT_EQ(first("rgba8", 2, 8), cv::Vec3b(30, 20, 10));
  EXPECT_EQ(first("bgra8", 2, 8), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(first("mono8", 2, 8), cv::Vec3b(10, 10, 10));
}

// Gray in YUV: only the places of the luminance matter.
TEST(RawImages, OfYuvHaveTheirLuminanceWhereTheEncodingSays) {
  const std::vector<std::uint8_t> uyvy = {128, 235, 128, 16};
  const std::vector<std::uint8_t> yuyv = {235, 128, 16, 128};
  EXPECT_EQ(color_pixels(image_with(uyvy, 2, 1, "yuv422", 4)).at<cv::Vec3b>(0, 0)[1], 255);
  EXPECT_EQ(color_pixels(image_with(yuyv, 2, 1, "yuv422_yuy2", 4)).at<cv::Vec3b>(0, 0)[1], 255);
}

// A red picture behind each of the colour filters.
TEST(RawImages, OfBayerPatternsHaveTheirColours) {
  for (const auto& [encoding, row, column] :
       {std::tuple{"bayer_rggb8", 0, 0}, std::tuple{"bayer_bggr8", 1, 1},
        std::tuple{"bayer_grbg8", 0, 1}, std::tuple{"bayer_gbrg8", 1, 0}}) {
    std::vector<std::uint8_t> data(64, 0);
    for (int y = row; y < 8; y += 2)
      for (int x = column; x < 8; x += 2) data[static_cast<std::size_t>(8 * y + x)] = 200;
    const cv::Mat bgr = color_pixels(image_with(data, 8, 8, encoding, 8));
    EXPECT_EQ(bgr.at<cv::Vec3b>(4, 4), cv::Vec3b(0, 0, 200)) << encoding;
  }
}

TEST(RawImages, OfDepthKeepTheirNumbers) {
  const std::vector<std::uint8_t> data = {1, 2, 3, 4};
  EXPECT_EQ(depth_pixels(image_with(data, 2, 1, "16UC1", 4)).at<std::uint16_t>(0, 1), 0x0403);
  ImageMessage swapped = image_with(data, 2, 1, "16UC1", 4);
  swapped.big_endian = true;
  EXPECT_EQ(depth_pixels(swapped).at<std::uint16_t>(0, 1), 0x0304);
  const float metres = 1.25F;
  std::vector<std::uint8_t> bytes(4);
  std::memcpy(bytes.data(), &metres, 4);
  EXPECT_EQ(depth_pixels(image_with(bytes, 1, 1, "32FC1", 4)).at<float>(0, 0), metres);
}

TEST(RawImages, WhoseNumbersDoNotFitAreRefused) {
  const std::vector<std::uint8_t> data(24);
  EXPECT_THROW(color_pixels(image_with(data, 4, 3, "bgr8", 12)), Error);  // too few bytes
  EXPECT_THROW(color_pixels(image_with(data, 4, 2, "bgr8", 11)), Error);  // rows overlap
  EXPECT_THROW(depth_pixels(image_with(data, 4, 2, "16UC1", 9)), Error);  // half a pixel apart
  EXPECT_THROW(color_pixels(image_with(data, -4, 2, "bgr8", 12)), Error);
  EXPECT_THROW(color_pixels(image_with(data, 2, 2, "16UC1", 4)), Error);
  EXPECT_THROW(depth_pixels(image_with(data, 4, 2, "bgr8", 12)), Error);
  EXPECT_THROW(depth_pixels(image_with(data, 1 << 30, 1 << 30, "16UC1", 12)), Error);
}

TEST(CompressedDepth, IsAPngFileMostOftenBehindAHeader) {
  const std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G', 1, 2};
  std::vector<std::uint8_t> behind(12, 7);
  behind.insert(behind.end(), png.begin(), png.end());
  const auto parts = [](const std::vector<std::uint8_t>& data, const char* format) {
    return compressed_depth(
        {.description = {.compressed = true, .encoding = format}, .data = data});
  };
  EXPECT_THAT(parts(png, "16UC1; png compressed").png, ElementsAreArray(png));
  EXPECT_THAT(parts(behind, "16UC1; compressedDepth png").png, ElementsAreArray(png));
  EXPECT_TRUE(parts(behind, "16UC1; compressedDepth png").inverse_header.empty());
  EXPECT_EQ(parts(behind, "32FC1; compressedDepth png").inverse_header.size(), 12U);
  EXPECT_THROW(parts(std::vector<std::uint8_t>(40, 7), "16UC1; compressedDepth rvl"), Error);
  EXPECT_THROW(parts({1, 2}, "16UC1; compressedDepth png"), Error);
}

TEST(InverseDepth, BecomesMetres) {
  ByteWriter header;
  header.number<std::int32_t>(0).number(100.0F).number(2.0F);
  const cv::Mat quantised = (cv::Mat_<std::uint16_t>(1, 2) << 52, 0);
  const cv::Mat metres = metres_of_inverse_depth(quantised, header.bytes());
  EXPECT_EQ(metres.at<float>(0, 0), 2.0F);
  EXPECT_EQ(metres.at<float>(0, 1), 0.0F);
}

}  // namespace
}  // namespace stillpoint::bag
