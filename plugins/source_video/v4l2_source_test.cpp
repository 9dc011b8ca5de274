// With devices that a test has made up: none of V4L2 is there.
#include "source_video/v4l2_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stop_token>
#include <thread>

#include "source_video/fake_v4l2.hpp"
#include "source_video/v4l2_pixels.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "support/error_text.hpp"

namespace stillpoint::source_video {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::error_text;
using ::testing::HasSubstr;

constexpr int kWidth = 16, kHeight = 16;
constexpr std::uint32_t kDepthStride = 40;  // bytes; 32 of them are pixels
constexpr std::uint64_t kSecond = 1'000'000;

FakeImage grey(std::uint64_t microseconds, std::uint8_t luma = 100) {
  FakeImage image{.microseconds = microseconds};
  for (int i = 0; i < kWidth * kHeight; ++i) image.bytes.insert(image.bytes.end(), {luma, 128});
  return image;
}

FakeImage depth(std::uint64_t microseconds, int millimetres = 1500) {
  FakeImage image{.bytes = std::vector<std::uint8_t>(kDepthStride * kHeight),
                  .microseconds = microseconds};
  for (std::size_t row = 0; row < kHeight; ++row)
    for (std::size_t column = 0; column < kWidth; ++column) {
      std::uint8_t* pixel = &image.bytes[row * kDepthStride + 2 * column];
      pixel[0] = static_cast<std::uint8_t>(millimetres & 0xff);
      pixel[1] = static_cast<std::uint8_t>(millimetres >> 8);
    }
  return image;
}

/// Without its last quarter: a decoder makes a whole image of it.
std::vector<std::uint8_t> truncated(std::vector<std::uint8_t> jpeg) {
  jpeg.resize(jpeg.size() * 3 / 4);
  return jpeg;
}

std::vector<std::uint8_t> jpeg_of_noise() {
  cv::Mat image(kHeight, kWidth, CV_8UC3);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 256);
  return encode_image(".jpg", image);
}

/// A camera of two devices, which is there as often as there are sessions.
class V4l2SourceTest : public ::testing::Test {
 protected:
  V4l2SourceTest() {
    options_.color_device = "/dev/video0";
    options_.depth_device = "/dev/video2";
    options_.live.timeout = 3600;
    context_.camera = CameraModel{.name = "small",
                                  .width = kWidth,
                                  .height = kHeight,
                                  .fx = 20,
                                  .fy = 20,
                                  .depth_factor = 1000};
    context_.log = [this](LogLevel, std::string_view line) { log_.emplace_back(line); };
  }
  V4l2Source source() const {
    return {options_, context_, std::make_shared<FakeV4l2>(std::vector{color_, depth_})};
  }
  std::string refused(Fault fault) const {
    return error_text(fault, [this] { static_cast<void>(source()); });
  }

  V4l2Source::Options options_;
  StageContext context_;
  std::vector<std::string> log_;
  FakeDevice color_{.name = "/dev/video0",
                    .pixels = V4L2_PIX_FMT_YUYV,
                    .width = kWidth,
                    .height = kHeight,
                    .stride = 2 * kWidth};
  FakeDevice depth_{.name = "/dev/video2",
                    .pixels = V4L2_PIX_FMT_Z16,
                    .width = kWidth,
                    .height = kHeight,
                    .stride = kDepthStride};
};

TEST_F(V4l2SourceTest, GivesFramesOfBothDevices) {
  color_.sessions = {FakeSession{.images = {grey(5 * kSecond), grey(5 * kSecond + 100'000, 200)}}};
  depth_.sessions = {
      FakeSession{.images = {depth(5 * kSecond + 4000), depth(5 * kSecond + 104'000, 2500)}}};
  V4l2Source camera = source();
  const auto first = camera.next();
  const auto second = camera.next();
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(second->time - first->time, 0.1, 2e-4);
  EXPECT_NEAR(first->bgr.at<cv::Vec3b>(3, 3)[1], 98, 2);  // 16 to 235 become 0 to 255
  EXPECT_FLOAT_EQ(first->depth.at<float>(7, 15), 1.5f);
  EXPECT_FLOAT_EQ(second->depth.at<float>(7, 15), 2.5f);
}

TEST_F(V4l2SourceTest, GoesOnWhenTheCameraIsPluggedInAgain) {
  color_.sessions = {FakeSession{.images = {grey(5 * kSecond)}}, std::nullopt,
                     FakeSession{.images = {grey(9 * kSecond)}}};
  depth_.sessions = {FakeSession{.images = {depth(5 * kSecond)}, .ends_unplugged = true},
                     FakeSession{.images = {depth(9 * kSecond)}}};
  V4l2Source camera = source();
  const auto first = camera.next();
  const auto second = camera.next();
  ASSERT_TRUE(first && second);
  EXPECT_GT(second->time, first->time);
  EXPECT_THAT(log_, ElementsAre(AllOf(HasSubstr("V4L2: /dev/video2: the camera was unplugged"),
                                      HasSubstr("; trying to open it again for 30 s")),
                                HasSubstr("V4L2: the camera is back")));
}

TEST_F(V4l2SourceTest, AStopEndsTheWaitForACameraThatHangs) {
  color_.sessions = {FakeSession{}};
  depth_.sessions = {FakeSession{}};
  V4l2Source camera = source();
  std::stop_source stop;
  camera.begin(stop.get_token());
  std::jthread user([&] { stop.request_stop(); });
  EXPECT_FALSE(camera.next());
}

TEST_F(V4l2SourceTest, CountsDamagedImages) {
  FakeImage cut = depth(5 * kSecond);
  cut.bytes.resize(100);
  color_.sessions = {FakeSession{
      .images = {FakeImage{.bytes = {1, 2, 3}, .microseconds = 4 * kSecond, .damaged = true},
                 grey(5 * kSecond)}}};
  depth_.sessions = {FakeSession{.images = {cut, depth(5 * kSecond + 5000)}}};
  V4l2Source camera = source();
  EXPECT_TRUE(camera.next());
  EXPECT_EQ(camera.left_out(), 2u);
  EXPECT_EQ(camera.report().skipped, 2u);
  EXPECT_THAT(camera.report().warnings, ElementsAre(HasSubstr("2 images came damaged")));
}

TEST_F(V4l2SourceTest, CountsTruncatedMotionJpegAsDamaged) {
  options_.color_format = V4l2Source::ColorFormat::kMjpeg;
  color_.pixels = V4L2_PIX_FMT_MJPEG;
  const std::vector<std::uint8_t> jpeg = jpeg_of_noise();
  color_.sessions = {
      FakeSession{.images = {{.bytes = truncated(jpeg), .microseconds = 5 * kSecond},
                             {.bytes = jpeg, .microseconds = 5 * kSecond + 100'000}}}};
  depth_.sessions = {
      FakeSession{.images = {depth(5 * kSecond, 1500), depth(5 * kSecond + 100'000, 2500)}}};
  V4l2Source camera = source();
  const auto frame = camera.next();
  ASSERT_TRUE(frame);
  EXPECT_FLOAT_EQ(frame->depth.at<float>(7, 7), 2.5f);
  EXPECT_THAT(camera.report().warnings, Contains(HasSubstr("1 images came damaged")));
}

TEST_F(V4l2SourceTest, SaysThatADeviceIsMissing) {
  color_.sessions = {FakeSession{}};
  EXPECT_THAT(refused(Fault::kData), HasSubstr("/dev/video2: cannot be opened: No such file"));
}

TEST_F(V4l2SourceTest, SaysWhatTheDeviceHas) {
  color_.sessions = {FakeSession{}};
  color_.pixels = V4L2_PIX_FMT_MJPEG;
  color_.width = 1280;
  EXPECT_THAT(refused(Fault::kUsage),
              AllOf(HasSubstr("/dev/video0: it does not have 16 x 16 pixels of YUYV, but 1280 x 16 "
                              "pixels of MJPG"),
                    HasSubstr("v4l2-ctl --list-formats-ext -d /dev/video0")));
}

// A camera has devices of another kind, too.
TEST_F(V4l2SourceTest, SaysThatADeviceHasNoImages) {
  color_.sessions = {FakeSession{}};
  color_.can = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_THAT(refused(Fault::kUsage), HasSubstr("/dev/video0: this device sends no images"));
}

TEST_F(V4l2SourceTest, NeedsACamera) {
  context_.camera.reset();
  EXPECT_THAT(refused(Fault::kUsage), HasSubstr("no camera is given; name a camera file"));
}

TEST(V4l2Pixels, OfMotionJpeg) {
  const std::vector<std::uint8_t> jpeg =
      encode_image(".jpg", cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(40, 80, 120)));
  const cv::Mat bgr = bgr_of({.bytes = jpeg}, V4L2_PIX_FMT_MJPEG, {kWidth, kHeight});
  ASSERT_EQ(bgr.size(), cv::Size(kWidth, kHeight));
  EXPECT_NEAR(bgr.at<cv::Vec3b>(4, 4)[2], 120, 4);
  EXPECT_TRUE(bgr_of({.bytes = jpeg}, V4L2_PIX_FMT_MJPEG, {2 * kWidth, kHeight}).empty());
  EXPECT_TRUE(
      bgr_of({.bytes = std::span(jpeg).first(20)}, V4L2_PIX_FMT_MJPEG, {kWidth, kHeight}).empty());
}

// Some drivers fill the rest of their buffers with zeros.
TEST(V4l2Pixels, ZerosBehindMotionJpegSayNothingOfIt) {
  std::vector<std::uint8_t> whole = jpeg_of_noise();
  std::vector<std::uint8_t> cut = truncated(whole);
  EXPECT_TRUE(bgr_of({.bytes = cut}, V4L2_PIX_FMT_MJPEG, {kWidth, kHeight}).empty());
  for (std::vector<std::uint8_t>* jpeg : {&whole, &cut}) jpeg->resize(100'000);
  EXPECT_FALSE(bgr_of({.bytes = whole}, V4L2_PIX_FMT_MJPEG, {kWidth, kHeight}).empty());
  EXPECT_TRUE(bgr_of({.bytes = cut}, V4L2_PIX_FMT_MJPEG, {kWidth, kHeight}).empty());
}

}  // namespace
}  // namespace stillpoint::source_video
