#include "orb_slam/constant_velocity.hpp"

#include <gtest/gtest.h>

namespace stillpoint::orb_slam {
namespace {

// Of the camera in its own frame, per second: translation, then rotation.
const Vector6d kVelocity = (Vector6d() << 0.3, -0.1, 0.2, 0.4, 0.2, -0.3).finished();
Pose world_from_camera(double seconds) { return exp_se3(kVelocity * seconds); }
Pose current_from_last(double last, double current) {
  return world_from_camera(current).inverse() * world_from_camera(last);
}

TEST(ConstantVelocity, GoesOnForAnyTime) {
  ConstantVelocity velocity;
  EXPECT_FALSE(velocity.has_value());
  velocity.update(current_from_last(0.5, 0.6), 0.1, false);
  ASSERT_TRUE(velocity.has_value());
  for (const double seconds : {0.0, 0.05, 0.3, 1.0})
    EXPECT_TRUE(velocity.predict(world_from_camera(0.6), seconds)
                    .isApprox(world_from_camera(0.6 + seconds), 1e-9));
  velocity.reset();
  EXPECT_FALSE(velocity.has_value());
}

TEST(ConstantVelocity, SmoothedOneFollowsSlowly) {
  ConstantVelocity velocity;
  velocity.update(Pose(Eigen::Translation3d(-0.2, 0, 0)), 0.2, true);  // 1 m/s, the first
  velocity.update(Pose::Identity(), 0.1, true);
  const double after_a_stop = velocity.predict(Pose::Identity(), 1.0).translation().x();
  EXPECT_GT(after_a_stop, 0.5);
  EXPECT_LT(after_a_stop, 0.9);
  velocity.update(Pose::Identity(), 0.1, false);
  EXPECT_TRUE(velocity.predict(Pose::Identity(), 1.0).isApprox(Pose::Identity()));
}

TEST(ConstantVelocity, TwoImagesOfOneTimeHaveNone) {
  ConstantVelocity velocity;
  velocity.update(current_from_last(0.5, 0.6), 0.1, true);
  velocity.update(Pose::Identity(), 0.0, true);
  EXPECT_FALSE(velocity.has_value());
}

TEST(MotionPrior, IsTighterForShorterTimesAndNoneBesideItsPose) {
  const Pose predicted = world_from_camera(2.0);
  const QuadraticCost near = motion_prior(predicted, 0.03), far = motion_prior(predicted, 0.3);
  EXPECT_NEAR(near.hessian(0, 0), 100 * far.hessian(0, 0), 1e-6 * near.hessian(0, 0));
  EXPECT_TRUE(near.moved_to(predicted.inverse()).gradient.isZero(1e-9));
  EXPECT_FALSE(near.moved_to(world_from_camera(2.1).inverse()).gradient.isZero(1e-3));
  EXPECT_TRUE(motion_prior(predicted, 0.0).hessian.allFinite());
}

}  // namespace
}  // namespace stillpoint::orb_slam
