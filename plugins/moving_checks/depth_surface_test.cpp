#include "moving_checks/depth_surface.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::moving_checks {
namespace {

using Kind = Surface::Kind;

Surface at(const cv::Mat& depth, int x, int y) {
  return surface_at(depth, cv::Point2f(x, y), 0.002, {});
}

TEST(SurfaceAt, PlanesAreSmoothHoweverSteep) {
  cv::Mat depth(100, 100, CV_32FC1);
  for (int y = 0; y < 100; ++y) depth.row(y) = 1.0 / (0.15 + 0.004 * y);
  const Surface surface = at(depth, 50, 50);
  EXPECT_EQ(surface.kind, Kind::kMeasured);
  EXPECT_NEAR(surface.inverse_depth, 0.35, 1e-6);
}

TEST(SurfaceAt, StepsAreEdgesOnBothSides) {
  cv::Mat depth(100, 100, CV_32FC1, cv::Scalar(3));
  depth.colRange(0, 50) = 2;
  EXPECT_EQ(at(depth, 48, 40).kind, Kind::kEdge);
  EXPECT_EQ(at(depth, 51, 40).kind, Kind::kEdge);
  EXPECT_EQ(at(depth, 40, 40).kind, Kind::kMeasured);
  EXPECT_EQ(at(depth, 60, 40).kind, Kind::kMeasured);
}

// A step of the inverse depth, at 2 m, by 0.08 m and three standard deviations.
TEST(SurfaceAt, WhatTheNoiseOfTheSensorMayBeIsNoEdge) {
  const auto kind = [](double step, double noise) {
    cv::Mat depth(100, 100, CV_32FC1, cv::Scalar(2));
    depth.colRange(53, 100) = 1 / (0.5 + step);
    return surface_at(depth, {50, 50}, noise, {}).kind;
  };
  for (const double noise : {0.0, 0.004, 0.04}) {
    SCOPED_TRACE(noise);
    const double largest = 0.08 / (2 * 2) + 3 * noise;
    EXPECT_EQ(kind(0.99 * largest, noise), Kind::kMeasured);
    EXPECT_EQ(kind(1.01 * largest, noise), Kind::kEdge);
  }
}

TEST(SurfaceAt, SmallHolesTakeTheDepthAroundThem) {
  cv::Mat depth(100, 100, CV_32FC1, cv::Scalar(2));
  depth(cv::Rect(48, 48, 5, 5)) = 0;
  const Surface surface = at(depth, 50, 50);
  EXPECT_EQ(surface.kind, Kind::kMeasured);
  EXPECT_NEAR(surface.inverse_depth, 0.5, 1e-6);
}

// The middle of a shadow between a near surface and a far one; its width is that in 640 x 480.
Kind in_shadow(cv::Size size, double width) {
  const double scale = pixel_scale(size);
  cv::Mat depth(size, CV_32FC1, cv::Scalar(4));
  const int middle = size.width / 2, half = cvRound(width * scale / 2);
  depth.colRange(0, middle - half) = 2;
  depth.colRange(middle - half, middle + half + 1) = 0;
  return at(depth, middle, size.height / 2).kind;
}

TEST(SurfaceAt, ShadowsBesideNearSurfacesAreEdgesInImagesOfAnySize) {
  for (const cv::Size size : {cv::Size(320, 240), cv::Size(640, 480), cv::Size(1280, 720)}) {
    SCOPED_TRACE(size.width);
    for (const double width : {4.0, 16.0, 40.0}) EXPECT_EQ(in_shadow(size, width), Kind::kEdge);
    EXPECT_EQ(in_shadow(size, 80), Kind::kNone);
  }
}

TEST(SurfaceAt, WithoutMeasurementsThereIsNone) {
  EXPECT_EQ(at(cv::Mat::zeros(100, 100, CV_32FC1), 50, 50).kind, Kind::kNone);
  EXPECT_EQ(at(cv::Mat(1, 1, CV_32FC1, cv::Scalar(0)), 0, 0).kind, Kind::kNone);
  const cv::Mat not_finite(9, 9, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(at(not_finite, 4, 4).kind, Kind::kNone);
}

}  // namespace
}  // namespace stillpoint::moving_checks
