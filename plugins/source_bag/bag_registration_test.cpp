#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "source_bag/bag_source_fixture.hpp"
#include "support/error_text.hpp"
#include "support/source_frames.hpp"

namespace stillpoint::source_bag {
namespace {

using ::testing::AllOf;
using testing::BagStyle;
using testing::camera_info_message;
using testing::color_image;
using testing::depth_image;
using ::testing::ElementsAre;
using testing::error_text;
using testing::frames_of;
using ::testing::HasSubstr;
using testing::image_message;
using testing::kImageHeight;
using testing::kImageWidth;
using testing::TestCameraInfo;

TEST_F(OneBagSourceTest, RefusesDepthOfWhichNothingSaysWhereItIs) {
  info();
  color(0);
  depth(0, "depth_frame", kUnregistered);
  EXPECT_THAT(error_text(Fault::kUsage, [&] { open(); }),
              AllOf(HasSubstr("is in the frame 'depth_frame'"),
                    HasSubstr("the bag has no CameraInfo of /camera/depth/image_raw"),
                    HasSubstr("source.depth_info_topic"), HasSubstr("source.registered=true")));
  EXPECT_EQ(open({.registered = true}).size(), 1U);
}

TEST_F(OneBagSourceTest, RefusesDepthThatTfDoesNotConnect) {
  info();
  depth_info();
  color(0);
  depth(0, "depth_frame", kUnregistered);
  EXPECT_THAT(error_text(Fault::kUsage, [&] { open(); }),
              AllOf(HasSubstr("cannot be registered to the colour images"),
                    HasSubstr("tf does not say how 'depth_frame' lies to 'color_frame'"),
                    HasSubstr("/tf_static"), HasSubstr("source.registered=true")));
}

// A patch a metre away, seen by a camera 10 cm to the left of the colour camera: with a focal
// length of 50 px, it is 5 px farther right in the colour image.
TEST_F(OneBagSourceTest, RegistersDepthByTf) {
  info();
  depth_info();
  tf();
  color(0);
  cv::Mat patch = depth_image(0);
  patch(cv::Rect(20, 15, 10, 8)) = 1000;
  add(kUnregistered, "sensor_msgs/Image", stamp(0),
      image_message(serialisation_, stamp(0), "depth_frame", patch, "16UC1"));
  color(1);
  add(kUnregistered, "sensor_msgs/Image", stamp(1),
      image_message(serialisation_, stamp(1), "depth_frame", patch.rowRange(0, 20), "16UC1"));
  cv::Mat metres;
  patch.convertTo(metres, CV_32F, 0.001);
  color(2);
  add(kUnregistered, "sensor_msgs/Image", stamp(2),
      image_message(serialisation_, stamp(2), "depth_frame", metres, "32FC1"));
  BagSource source = open();
  const auto frames = frames_of(source);
  cv::Mat expected = cv::Mat::zeros(kImageHeight, kImageWidth, CV_32FC1);
  expected(cv::Rect(25, 15, 10, 8)) = 1;
  ASSERT_EQ(frames.size(), 2U);
  for (const Frame& frame : frames) {
    EXPECT_EQ(cv::norm(frame.depth, expected, cv::NORM_INF), 0);
    EXPECT_EQ(frame.bgr.size(), frame.depth.size());
  }
  EXPECT_THAT(source.report().warnings,
              ElementsAre(HasSubstr("the depth image has 64 x 20 pixels, but its camera")));
}

/// A patch of depth.
cv::Mat patch_at(int x, int y, int raw) {
  cv::Mat patch = depth_image(0);
  patch(cv::Rect(x, y, 10, 8)) = raw;
  return patch;
}

cv::Mat in_metres(const cv::Mat& raw, double factor) {
  cv::Mat metres;
  raw.convertTo(metres, CV_32F, 1 / factor);
  return metres;
}

// As of kinect2_bridge: colour as recorded, with one CameraInfo for raw and rectified images.
TEST_F(OneBagSourceTest, DoesNotUndistortRectifiedDepth) {
  const TestCameraInfo camera{.distortion = {0.3, 0, 0, 0, 0}, .rectified_fx = 50};  // that of K
  const cv::Mat patch = patch_at(52, 4, 1000);
  add("/kinect2/qhd/camera_info", "sensor_msgs/CameraInfo", stamp(0),
      camera_info_message(serialisation_, camera));
  add("/kinect2/qhd/image_color", "sensor_msgs/Image", stamp(0),
      image_message(serialisation_, stamp(0), "rgb", color_image(9), "bgr8"));
  add("/kinect2/qhd/image_depth_rect", "sensor_msgs/Image", stamp(0),
      image_message(serialisation_, stamp(0), "rgb", patch, "16UC1"));
  BagSource source = open();
  const auto frames = frames_of(source);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(cv::norm(frames[0].depth, in_metres(patch, 1000), cv::NORM_INF), 0);
  EXPECT_EQ(frames[0].bgr.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 0));  // not seen: it is undistorted
}

/// As realsense-viewer writes it: depth in 0.5 mm, 10 cm to the left of the colour camera.
class RealSenseBagSourceTest : public BagSourceTest {
 protected:
  RealSenseBagSourceTest() : BagSourceTest(BagStyle{"bag", "lz4"}) {
    add("/device_0/sensor_0/option/Depth Units/value", "std_msgs/Float32", stamp(0),
        testing::ByteWriter(serialisation_).number(0.0005F).bytes());
    for (const char* stream : {kColorStream, kDepthStream})
      add(std::string(stream) + "/info/camera_info", "sensor_msgs/CameraInfo", stamp(0),
          camera_info_message(serialisation_, {.frame = "", .rectified_fx = 0}));
    image(kColorStream, color_image(9), "bgr8");
    image(kDepthStream, patch_at(20, 15, 2000), "mono16");
  }
  void image(const std::string& stream, const cv::Mat& pixels, const std::string& encoding) {
    add(stream + "/image/data", "sensor_msgs/Image", stamp(0),
        image_message(serialisation_, stamp(0), "0", pixels, encoding));
  }
  /// Where the first stream of the device is in this one: without rotation.
  void transform(const std::string& stream, double x) {
    testing::ByteWriter writer(serialisation_);
    for (const double number : {x, 0., 0., 0., 0., 0., 1.}) writer.number(number);
    add(stream + "/tf/0", "geometry_msgs/Transform", stamp(0), writer.bytes());
  }
  static constexpr const char* kColorStream = "/device_0/sensor_1/Color_0";
  static constexpr const char* kDepthStream = "/device_0/sensor_0/Depth_0";
};

TEST_F(RealSenseBagSourceTest, RegistersDepthByTheTransformsOfTheSdk) {
  transform(kColorStream, 0.06);
  transform(kDepthStream, -0.04);
  BagSource source = open();
  const auto frames = frames_of(source);
  ASSERT_EQ(frames.size(), 1U);
  const cv::Mat expected = in_metres(patch_at(25, 15, 2000), 2000);
  EXPECT_EQ(cv::norm(frames[0].depth, expected, cv::NORM_INF), 0);
}

TEST_F(RealSenseBagSourceTest, RefusesDepthWithoutThem) {
  transform(kColorStream, 0.06);
  EXPECT_THAT(error_text(Fault::kUsage, [&] { open(); }),
              AllOf(HasSubstr("a recording of the RealSense SDK, whose depth is not registered"),
                    HasSubstr("align_depth"), HasSubstr("source.registered=true")));
  BagSource source = open({.registered = true});
  EXPECT_FLOAT_EQ(source.next()->depth.at<float>(16, 21), 1.0F);
}

}  // namespace
}  // namespace stillpoint::source_bag
