#include "orb_slam/depth_view.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "orb_slam/test_surfaces.hpp"

namespace stillpoint::orb_slam {
namespace {

int patches_of(const DepthView& view) {
  int count = 0;
  for (int row = 0; row < view.rows(); ++row)
    for (int column = 0; column < view.columns(); ++column)
      count += view.patch(column, row).weight > 0;
  return count;
}

// Patches whose middle lies in `area`, px.
int patches_in(const DepthView& view, const cv::Rect& area) {
  int count = 0;
  for (int row = 0; row < view.rows(); ++row)
    for (int column = 0; column < view.columns(); ++column)
      count += area.contains({column * view.cell() + 4, row * view.cell() + 4}) &&
               view.patch(column, row).weight > 0;
  return count;
}

TEST(DepthView, PatchesLieOnTheirPlane) {
  const WorldPlane slanted{Eigen::Vector3d(0.3, -0.2, 1).normalized(), 2.0};
  const DepthView view(*render_planes({slanted}, Pose::Identity()), {});
  ASSERT_EQ(view.columns(), 80);
  ASSERT_EQ(view.rows(), 60);
  EXPECT_EQ(patches_of(view), 76 * 56);
  for (int row = 2; row < 58; ++row) {
    for (int column = 2; column < 78; ++column) {
      const PlanePatch& patch = view.patch(column, row);
      EXPECT_NEAR(patch.point.cast<double>().dot(slanted.normal), 2.0, 1e-4);
      EXPECT_LT((patch.normal.cast<double>() + slanted.normal).norm(), 1e-3) << "to the camera";
      EXPECT_EQ(view.at(patch.point), &patch);
    }
  }
}

TEST(DepthView, NoiseOfDistanceAndNormalIsNoLargerThanSaid) {
  const DepthView view(*render_planes({kAhead}, Pose::Identity(), 0, 0.002), {});
  double distance = 0, tilt = 0;
  for (int row = 2; row < 58; ++row) {
    for (int column = 2; column < 78; ++column) {
      const PlanePatch& patch = view.patch(column, row);
      ASSERT_GT(patch.weight, 0);
      distance += std::pow((patch.point.z() - 2.5F) / view.distance_sigma(patch), 2);
      tilt += std::pow(patch.normal.x() / view.normal_sigma(patch), 2);
    }
  }
  EXPECT_LT(distance / (76 * 56), 1.0);
  EXPECT_NEAR(tilt / (76 * 56), 1.0, 0.3);
}

TEST(DepthView, OfANoisySensorHasPatchesWhenItsNoiseIsKnown) {
  constexpr double kNoise = 0.01;  // five times a Kinect's
  const FramePtr frame = render_planes({kAhead}, Pose::Identity(), 0, kNoise);
  EXPECT_LT(patches_of(DepthView(*frame, {})), 100) << "taken for discontinuities";
  EXPECT_GT(patches_of(DepthView(*with_surface_noise(frame, kNoise), {})), 0.99 * 76 * 56);
}

// As many patches in images of any size.
TEST(DepthView, CellsGrowWithTheImage) {
  const FramePtr large = render_planes({kAhead}, Pose::Identity());
  const auto scaled = [&](double factor) {
    auto camera = std::make_shared<Camera>(*large->camera);
    camera->width = cvRound(factor * camera->width),
    camera->height = cvRound(factor * camera->height);
    for (double* value : {&camera->fx, &camera->fy, &camera->cx, &camera->cy}) *value *= factor;
    Frame frame = *large;
    cv::resize(large->depth, frame.depth, {camera->width, camera->height}, 0, 0, cv::INTER_NEAREST);
    frame.camera = std::move(camera);
    return patches_of(DepthView(frame, {}));
  };
  EXPECT_EQ(scaled(1), 76 * 56);
  EXPECT_EQ(scaled(0.5), 76 * 56);
  EXPECT_EQ(scaled(2), 76 * 56);
}

TEST(DepthView, EdgesHaveNone) {
  const auto frame = std::make_shared<Frame>(*render_planes({kAhead}, Pose::Identity()));
  frame->depth = frame->depth.clone();
  frame->depth.colRange(320, 640) = 3.0F;
  const DepthView view(*frame, {});
  EXPECT_EQ(patches_in(view, {308, 24, 24, 400}), 0);
  EXPECT_GT(patches_in(view, {100, 24, 100, 400}), 500);
}

TEST(DepthView, WhatIsNotMeasuredOrMovesHasNone) {
  const auto frame = std::make_shared<Frame>(*render_planes({kAhead}, Pose::Identity()));
  frame->depth = frame->depth.clone();
  frame->depth(cv::Rect(0, 0, 160, 480)) = 0.0F;
  StaticWeights weights;
  weights.track = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  weights.track(cv::Rect(400, 0, 240, 480)) = 0;
  weights.track(cv::Rect(240, 0, 100, 480)) = 102;
  const DepthView view(*frame, weights);
  EXPECT_EQ(patches_in(view, {0, 0, 160, 480}), 0);
  EXPECT_EQ(patches_in(view, {400, 0, 240, 480}), 0);
  EXPECT_FLOAT_EQ(view.patch(36, 30).weight, 0.4F);
  EXPECT_FLOAT_EQ(view.patch(25, 30).weight, 1.0F);
}

// Real sensors have single pixels without depth, and patches of them.
TEST(DepthView, HolesLeaveThePlanesAroundThem) {
  const WorldPlane slanted{Eigen::Vector3d(0.3, -0.2, 1).normalized(), 2.0};
  const auto frame = std::make_shared<Frame>(*render_planes({slanted}, Pose::Identity()));
  frame->depth = frame->depth.clone();
  cv::Mat random(frame->depth.size(), CV_8U);
  cv::RNG(1).fill(random, cv::RNG::UNIFORM, 0, 100);
  frame->depth.setTo(0, random < 10);
  frame->depth.setTo(std::numeric_limits<float>::quiet_NaN(), random == 10);
  frame->depth(cv::Rect(320, 240, 12, 12)) = 0;
  const DepthView view(*frame, {});
  EXPECT_GT(patches_of(view), 0.98 * 76 * 56);
  for (int row = 2; row < 58; ++row) {
    for (int column = 2; column < 78; ++column) {
      const PlanePatch& patch = view.patch(column, row);
      if (patch.weight <= 0) continue;
      EXPECT_NEAR(patch.point.cast<double>().dot(slanted.normal), 2.0, 0.002);
      EXPECT_LT((patch.normal.cast<double>() + slanted.normal).norm(), 0.01);
    }
  }
}

TEST(DepthView, OutsideTheImageIsNothing) {
  const DepthView view(*render_planes({kAhead}, Pose::Identity()), {});
  EXPECT_EQ(view.at({5, 0, 2}), nullptr);
  EXPECT_EQ(view.at({0, 0, -2}), nullptr);
  EXPECT_EQ(view.at({0, 0, 0}), nullptr);
  EXPECT_EQ(DepthView().at({0, 0, 1}), nullptr);
}

}  // namespace
}  // namespace stillpoint::orb_slam
