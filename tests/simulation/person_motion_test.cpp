#include <gtest/gtest.h>

#include "simulation/ball.hpp"
#include "simulation/person.hpp"

namespace stillpoint::simulation {
namespace {

TEST(PersonMotion, WalksWithOneFootOnTheFloorAndNoneBelow) {
  const auto motion = person_motion({});
  for (double t = 0; t < 6; t += 0.05) {
    const PersonPose pose = motion(t);
    const double left = pose[kLeftFoot].translation().z();
    const double right = pose[kRightFoot].translation().z();
    EXPECT_NEAR(std::min(left, right), 0.045 * 1.76, 1e-9);
    EXPECT_LT(std::max(left, right), 0.4);
  }
}

TEST(PersonMotion, MovesSmoothlyAtItsSpeed) {
  PersonOptions options;
  options.speed = 1.0;
  const auto motion = person_motion(options);
  double way = 0;
  for (double t = 0; t < 14; t += 0.02) {
    const double step =
        (motion(t + 0.02)[kPelvis].translation() - motion(t)[kPelvis].translation()).norm();
    EXPECT_LT(step, 0.05);
    way += step;
  }
  EXPECT_NEAR(way / 14, 1.0, 0.1);
}

TEST(PersonMotion, SitsStillButGestures) {
  PersonOptions options;
  options.pose = PersonOptions::Pose::kSit;
  options.path = {1, 2};
  const auto motion = person_motion(options);
  double reach = 0;
  for (double t = 0; t < 20; t += 0.1) {
    EXPECT_TRUE(motion(t)[kPelvis].isApprox(motion(0)[kPelvis], 1e-12));
    reach = std::max(
        reach,
        (motion(t)[kLeftForearm].translation() - motion(0)[kLeftForearm].translation()).norm());
  }
  EXPECT_GT(reach, 0.05);
  EXPECT_LT(reach, 0.6);
}

TEST(Ball, FliesFreelyBetweenTheHands) {
  const BallOptions options{.flight = 1.0, .pause = 0.5};
  const Eigen::Vector3d from(options.from.data());
  const Eigen::Vector3d to(options.to.data());
  EXPECT_TRUE(ball_position(options, 0).isApprox(from));
  EXPECT_TRUE(ball_position(options, 1.2).isApprox(to));
  EXPECT_TRUE(ball_position(options, 1.5).isApprox(to));
  EXPECT_TRUE(ball_position(options, 2.9).isApprox(from));
  const double h = 1e-3;
  const Eigen::Vector3d acceleration =
      (ball_position(options, 0.4 + h) - 2 * ball_position(options, 0.4) +
       ball_position(options, 0.4 - h)) /
      (h * h);
  EXPECT_TRUE(acceleration.isApprox(Eigen::Vector3d(0, 0, -9.81), 1e-4));
}

}  // namespace
}  // namespace stillpoint::simulation
