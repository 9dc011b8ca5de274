#include "depth_registration/depth_registration.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

namespace stillpoint::depth_registration {
namespace {

cv::Mat flat_depth(int value, cv::Size size) { return {size, CV_16UC1, cv::Scalar(value)}; }

Camera small_camera(int width, int height, double focal) {
  return {.width = width,
          .height = height,
          .fx = focal,
          .fy = focal,
          .cx = (width - 1) / 2.0,
          .cy = (height - 1) / 2.0};
}

TEST(DepthRegistrationTest, ALargerImageHasNoHoles) {
  const DepthRegistration registration(small_camera(64, 48, 60), small_camera(128, 96, 120),
                                       Pose::Identity());
  cv::Mat depth = flat_depth(900, {64, 48});
  depth(cv::Rect(10, 20, 5, 7)).setTo(0);
  cv::Mat expected = flat_depth(900, {128, 96});
  expected(cv::Rect(20, 40, 10, 14)).setTo(0);
  EXPECT_EQ(cv::norm(registration.register_image(depth, 1000), expected, cv::NORM_INF), 0);
}

// A wall that stands across the depth camera's view, seen by a camera turned towards it and aside.
TEST(DepthRegistrationTest, EveryPointOfAWallStaysOnTheWall) {
  const Camera camera = small_camera(64, 48, 60);
  Pose color_from_depth = Pose::Identity();
  color_from_depth.linear() = exp_so3({0, 0.2, 0.02});
  color_from_depth.translation() = Eigen::Vector3d(0.05, -0.02, 0.01);
  const cv::Mat moved = DepthRegistration(camera, camera, color_from_depth)
                            .register_image(flat_depth(2000, {64, 48}), 1000);
  int seen = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      const double z = moved.at<std::uint16_t>(y, x) / 1000.0;
      if (z == 0) continue;
      ++seen;
      const Eigen::Vector3d point = color_from_depth.inverse() * camera.unproject(x, y, z);
      EXPECT_NEAR(point.z(), 2.0, 0.01) << x << ' ' << y;  // half a pixel aside on a tilted wall
    }
  EXPECT_GT(seen, 2000);
}

TEST(DepthRegistrationTest, WhatLiesBehindTheColourCameraIsLeftOut) {
  const Camera camera = small_camera(64, 48, 60);
  Pose color_from_depth = Pose::Identity();
  color_from_depth.translation().z() = -1.5;
  const cv::Mat moved = DepthRegistration(camera, camera, color_from_depth)
                            .register_image(flat_depth(1000, {64, 48}), 1000);
  EXPECT_EQ(cv::countNonZero(moved), 0);
}

// In metres, or in a unit of its own: the same, to half a unit.
TEST(DepthRegistrationTest, MetresAreMovedAsWholeNumbersAre) {
  Pose color_from_depth = Pose::Identity();
  color_from_depth.linear() = exp_so3({0.01, 0.2, 0.02});
  color_from_depth.translation() = Eigen::Vector3d(0.05, -0.02, 0.01);
  const Camera camera = small_camera(64, 48, 60);
  const DepthRegistration registration(camera, camera, color_from_depth);
  cv::Mat raw = flat_depth(2000, {64, 48}), metres;
  raw(cv::Rect(20, 10, 20, 20)) = 1200;
  raw(cv::Rect(5, 5, 3, 3)) = 0;
  raw.convertTo(metres, CV_32F, 0.001);
  metres(cv::Rect(5, 5, 3, 3)) = std::numeric_limits<float>::quiet_NaN();
  const cv::Mat moved = registration.register_image(metres, 1);
  cv::Mat expected;
  registration.register_image(raw, 1000).convertTo(expected, CV_32F, 0.001);
  EXPECT_EQ(moved.type(), CV_32FC1);
  EXPECT_LT(cv::norm(moved, expected, cv::NORM_INF), 0.00051);
}

}  // namespace
}  // namespace stillpoint::depth_registration
