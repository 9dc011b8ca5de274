#include "orb_slam/plane_registration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "orb_slam/test_surfaces.hpp"
#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

const std::vector<WorldPlane> kCorner = {kAhead, kRight, kFloor};
const Pose kMoved = pose_at({0.04, -0.03, 0.05}, {0.02, -0.03, 0.015});  // world from camera

PlaneRegistration register_at_rest(const std::vector<WorldPlane>& planes, double noise) {
  const DepthView other(*render_planes(planes, Pose::Identity(), 0, noise), {});
  const DepthView current(*render_planes(planes, Pose::Identity(), 1, noise), {});
  const PlacedView placed{&other};
  return register_planes(current, {&placed, 1}, Pose::Identity(), 0.05);
}

// Whether the camera may move by this twist for all that the surfaces tell.
bool free_to(const PlaneRegistration& registration, const Vector6d& twist) {
  return (registration.cost.hessian * twist).norm() < 1e-4 * registration.cost.hessian.norm();
}

int constrained_directions(const PlaneRegistration& registration) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(registration.cost.hessian);
  return static_cast<int>((eigen.eigenvalues().array() > 1e-6 * eigen.eigenvalues()[5]).count());
}

Vector6d twist(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  Vector6d result;
  result << translation, rotation;
  return result;
}

// Where rounds of registration take the camera, from the first camera's pose.
Pose find(
    const std::vector<WorldPlane>& planes, const Pose& world_from_camera, double noise,
    const StaticWeights& weights = {},
    const std::function<void(cv::Mat&)>& spoil = [](cv::Mat&) {}) {
  const DepthView other(*render_planes(planes, Pose::Identity(), 0, noise), {});
  const PlacedView placed{&other};
  const auto frame = std::make_shared<Frame>(*render_planes(planes, world_from_camera, 1, noise));
  frame->depth = frame->depth.clone();
  spoil(frame->depth);
  const DepthView current(*frame, weights);
  const auto term = [&](const Pose& pose, int round) {
    return register_planes(current, {&placed, 1}, pose, std::max(0.12 * std::pow(0.6, round), 0.02))
        .cost;
  };
  return solve_pose({}, *frame->camera, Pose::Identity(), term).camera_from_world.inverse();
}

// 12 cm off: an outlier to a Kinect, and within the noise of a sensor ten times as bad.
TEST(PlaneRegistration, GatesFollowTheNoiseOfTheSensor) {
  const auto inlier_share = [](double noise) {
    const auto render = [&](double ahead, std::uint32_t index) {
      return with_surface_noise(render_planes({kAhead}, pose_at({0, 0, ahead}, {0, 0, 0}), index),
                                noise);
    };
    const DepthView other(*render(0, 0), {}), current(*render(0.12, 1), {});
    const PlacedView placed{&other};
    return register_planes(current, {&placed, 1}, Pose::Identity(), 0.02).agreement();
  };
  EXPECT_EQ(inlier_share(0.002), 0.0);
  EXPECT_EQ(inlier_share(0.02), 1.0);
}

TEST(PlaneRegistration, AWallLeavesThreeDirectionsFree) {
  for (const double noise : {0.0, 0.002}) {
    const PlaneRegistration wall = register_at_rest({kAhead}, noise);
    EXPECT_EQ(constrained_directions(wall), 3);
    if (noise > 0) continue;
    EXPECT_TRUE(free_to(wall, twist({1, 0, 0}, {0, 0, 0})));
    EXPECT_TRUE(free_to(wall, twist({0, 1, 0}, {0, 0, 0})));
    EXPECT_TRUE(free_to(wall, twist({0, 0, 0}, {0, 0, 1})));
    EXPECT_FALSE(free_to(wall, twist({0, 0, 1}, {0, 0, 0})));
  }
}

TEST(PlaneRegistration, TwoPlanesLeaveTheirLineFree) {
  for (const double noise : {0.0, 0.002}) {
    const PlaneRegistration edge = register_at_rest({kAhead, kRight}, noise);
    EXPECT_EQ(constrained_directions(edge), 5);
    if (noise > 0) continue;
    EXPECT_TRUE(free_to(edge, twist({0, 1, 0}, {0, 0, 0})));
  }
}

TEST(PlaneRegistration, ThreePlanesHoldEverything) {
  EXPECT_EQ(constrained_directions(register_at_rest(kCorner, 0.0)), 6);
  EXPECT_EQ(constrained_directions(register_at_rest(kCorner, 0.002)), 6);
}

TEST(PlaneRegistration, MotionInACornerIsFound) {
  const Pose exact = find(kCorner, kMoved, 0.0);
  EXPECT_LT(metres_between(exact, kMoved), 1e-4);
  EXPECT_LT(radians_between(exact, kMoved), 1e-4);
  const Pose noisy = find(kCorner, kMoved, 0.002);
  EXPECT_LT(metres_between(noisy, kMoved), 0.002);
  EXPECT_LT(radians_between(noisy, kMoved), 0.001);
}

TEST(PlaneRegistration, WhereACameraSlidesItStaysAsItWas) {
  const Pose slid = pose_at({0.03, 0.02, 0.04}, {0.01, 0.02, 0});
  const Pose found = find({kAhead}, slid, 0.002);
  EXPECT_NEAR(found.translation().x(), 0.0, 0.003);
  EXPECT_NEAR(found.translation().y(), 0.0, 0.003);
  EXPECT_NEAR(found.translation().z(), 0.04, 0.002);
}

TEST(PlaneRegistration, WhatMovesDoesNotPull) {
  // Somebody's front, 3 cm nearer than the wall a moment ago: near enough to be taken for it.
  const cv::Rect person(200, 60, 160, 300);
  const auto step_forward = [&](cv::Mat& depth) { depth(person) -= 0.03F; };
  StaticWeights weights;
  weights.track = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  weights.track(person) = 0;
  const double unweighted = metres_between(find(kCorner, kMoved, 0.0, {}, step_forward), kMoved);
  const double weighted = metres_between(find(kCorner, kMoved, 0.0, weights, step_forward), kMoved);
  EXPECT_LT(weighted, 1e-4);
  EXPECT_GT(unweighted, 10 * weighted);
}

TEST(PlaneRegistration, NeighboursCountTogether) {
  const PlaneRegistration corner = register_at_rest(kCorner, 0.0);
  EXPECT_GT(corner.inlier_count, 2 * kMaxPatches);
  // Were all patches like the best there are, they would know no more than this.
  const double best = 1.0 / (0.004 * 0.004);
  EXPECT_LT((corner.cost.hessian.topLeftCorner<3, 3>().trace()), kMaxPatches * best);
}

TEST(PlaneRegistration, AnotherPlaceDoesNotAgree) {
  const DepthView other(*render_planes(kCorner, Pose::Identity()), {});
  const DepthView current(*render_planes(kCorner, pose_at({0, 0, 0.5}), 1), {});
  const PlacedView placed{&other};
  const PlaneRegistration result = register_planes(current, {&placed, 1}, Pose::Identity(), 0.02);
  EXPECT_GT(result.overlap(), 0.5);
  EXPECT_LT(result.agreement(), 0.8);
  EXPECT_EQ(register_planes(DepthView(), {&placed, 1}, Pose::Identity(), 0.02).overlap(), 0.0);
  EXPECT_EQ(register_planes(current, {}, Pose::Identity(), 0.02).agreement(), 0.0);
}

}  // namespace
}  // namespace stillpoint::orb_slam
