#include "ros2_messages/pose_messages.hpp"

#include <gtest/gtest.h>

namespace stillpoint::ros2_messages {
namespace {

/// The camera is 1 m above the base, looking forward.
Mounting robot() {
  Mounting mounting{.base = "base_link"};
  mounting.base_from_camera = mounting.map_from_world;
  mounting.base_from_camera.translation() = Eigen::Vector3d(0, 0, 1);
  mounting.map_from_world = mounting.base_from_camera;
  return mounting;
}

TrackResult tracked(const Pose& world_from_camera) {
  TrackResult result{.state = TrackState::kTracking};
  result.world_from_camera = world_from_camera;
  return result;
}

TEST(PoseSequence, TheMapIsWhereTheBaseWas) {
  PoseSequence poses(robot());
  const auto first = poses.next(1, tracked(Pose::Identity()));
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->pose.pose.isApprox(Pose::Identity()));
  EXPECT_EQ(first->transform.child, "base_link");
  const auto second = poses.next(1.5, tracked(Pose(Eigen::Translation3d(0, 0, 2))));  // forward
  EXPECT_LT((second->pose.pose.translation() - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(second->odometry.twist[0], 4, 1e-12);  // m/s along x
}

TEST(PoseSequence, ALostFrameHasNoPoseAndNoVelocityAfterIt) {
  PoseSequence poses(robot());
  poses.next(1, tracked(Pose::Identity()));
  EXPECT_FALSE(poses.next(2, TrackResult{.state = TrackState::kLost}));
  const auto next = poses.next(3, tracked(Pose(Eigen::Translation3d(0, 0, 2))));
  EXPECT_EQ(next->odometry.twist, Vector6d::Zero());
}

// The camera turns about its own y axis, 1 m above the base: the base does not move, but turns.
TEST(PoseSequence, UncertaintyIsThatOfTheBaseInTheMap) {
  PoseSequence poses(robot());
  TrackResult result = tracked(Pose::Identity());
  result.uncertainty.emplace();
  result.uncertainty->covariance = Matrix6d::Zero();
  result.uncertainty->covariance(4, 4) = 1;  // about y, downward
  Matrix6d expected = Matrix6d::Zero();
  expected(5, 5) = 1;  // about z, upward
  EXPECT_TRUE(poses.next(1, result)->odometry.covariance.isApprox(expected));
  result.uncertainty->covariance = Matrix6d::Zero();
  result.uncertainty->covariance(3, 3) = 1;  // about x, to the right: the base swings below
  const Matrix6d swinging = poses.next(2, result)->odometry.covariance;
  EXPECT_NEAR(swinging(0, 0), 1, 1e-12);
  EXPECT_NEAR(swinging(4, 4), 1, 1e-12);
}

}  // namespace
}  // namespace stillpoint::ros2_messages
