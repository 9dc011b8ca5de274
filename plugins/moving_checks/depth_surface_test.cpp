#include "moving_checks/depth_surface.hpp"

#include <gtest/gtest.h>

#include <limits>

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

TEST(SurfaceAt, SmallHolesTakeTheDepthAroundThem) {
  cv::Mat depth(100, 100, CV_32FC1, cv::Scalar(2));
  depth(cv::Rect(48, 48, 5, 5)) = 0;
  const Surface surface = at(depth, 50, 50);
  EXPECT_EQ(surface.kind, Kind::kMeasured);
  EXPECT_NEAR(surface.inverse_depth, 0.5, 1e-6);
}

TEST(SurfaceAt, ShadowsBesideNearSurfacesAreEdges) {
  cv::Mat depth(100, 100, CV_32FC1, cv::Scalar(4));
  depth.colRange(0, 40) = 2;
  depth.colRange(40, 56) = 0;
  EXPECT_EQ(at(depth, 48, 50).kind, Kind::kEdge);
}

TEST(SurfaceAt, WithoutMeasurementsThereIsNone) {
  EXPECT_EQ(at(cv::Mat::zeros(100, 100, CV_32FC1), 50, 50).kind, Kind::kNone);
  EXPECT_EQ(at(cv::Mat(1, 1, CV_32FC1, cv::Scalar(0)), 0, 0).kind, Kind::kNone);
  const cv::Mat not_finite(9, 9, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(at(not_finite, 4, 4).kind, Kind::kNone);
}

}  // namespace
}  // namespace stillpoint::moving_checks
