#include "bag/registration.hpp"

#include <gtest/gtest.h>

namespace stillpoint::bag {
namespace {

CameraInfoMessage camera(double focal_length, int width = 640) {
  CameraInfoMessage info{.width = width, .height = 480};
  info.intrinsics = {focal_length, 0, 319.5, 0, focal_length, 239.5, 0, 0, 1};
  return info;
}

bool registered(const std::string& color_frame, const std::string& depth_frame,
                const std::string& depth_topic = "/camera/depth/image") {
  return is_registered({"/camera/rgb/image", color_frame}, {depth_topic, depth_frame});
}

bool registered(const CameraInfoMessage& color, const CameraInfoMessage& depth) {
  return is_registered({"/rgb", "camera", color}, {"/depth", "camera", depth});
}

TEST(Registration, IsThatOfTheSameFrame) {
  EXPECT_TRUE(registered("openni_rgb_optical_frame", "openni_rgb_optical_frame"));
  EXPECT_FALSE(registered("openni_rgb_optical_frame", "openni_depth_optical_frame"));
}

TEST(Registration, IsSaidByTheNameOfTheTopic) {
  EXPECT_TRUE(registered("color", "depth", "/camera/depth_registered/image_raw"));
  EXPECT_TRUE(registered("0", "0", "/camera/aligned_depth_to_color/image_raw"));
}

TEST(Registration, IsNotProvedByFramesThatNameNoCamera) {
  for (const char* frame : {"", "0", "1", "12"}) EXPECT_FALSE(registered(frame, frame)) << frame;
  EXPECT_TRUE(registered("camera1", "camera1"));
}

TEST(Registration, IsNotThatOfCamerasThatDiffer) {
  EXPECT_TRUE(registered(camera(525), camera(525)));
  EXPECT_FALSE(registered(camera(525), camera(575)));
  EXPECT_FALSE(registered(camera(525), camera(525, 1280)));
}

// That of a Kinect was calibrated for colour, and the driver knows one of its own for depth; others
// leave it out.
TEST(Registration, IsThatOfOneCameraWithTwoCalibrations) {
  EXPECT_TRUE(registered(camera(535.4), camera(525)));
  EXPECT_TRUE(registered(camera(535.4), CameraInfoMessage{.width = 640, .height = 480}));
  EXPECT_TRUE(registered(camera(535.4), CameraInfoMessage{})) << "an empty one";
}

}  // namespace
}  // namespace stillpoint::bag
