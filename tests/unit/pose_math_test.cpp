#include "stillpoint/pose_math.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stillpoint {
namespace {

Pose random_pose() { return exp_se3(Vector6d::Random() * 1.5); }

TEST(PoseMath, ExpAndLogAreInverse) {
  std::srand(1);
  for (int i = 0; i < 100; ++i) {
    const Vector6d twist = Vector6d::Random() * 1.7;
    EXPECT_LT((log_se3(exp_se3(twist)) - twist).norm(), 1e-9);
  }
}

TEST(PoseMath, TinyAndHalfTurnRotationsAreExact) {
  for (double angle : {0.0, 1e-12, 1e-7, 1e-4, 3.141592}) {
    const Eigen::Vector3d rotation = angle * Eigen::Vector3d(1, 2, -2) / 3.0;
    EXPECT_LT((log_so3(exp_so3(rotation)) - rotation).norm(), 1e-9) << angle;
  }
}

TEST(PoseMath, InterpolationStopsAtBothEnds) {
  const Pose a = random_pose(), b = random_pose();
  EXPECT_TRUE(interpolate(a, b, 0).isApprox(a, 1e-12));
  EXPECT_TRUE(interpolate(a, b, 1).isApprox(b, 1e-12));
  EXPECT_NEAR(rotation_angle(a.inverse() * interpolate(a, b, 0.25)),
              0.25 * rotation_angle(a.inverse() * b), 1e-9);
}

TEST(PoseMath, AlignmentFindsScaleRotationAndTranslation) {
  const Eigen::Matrix3Xd source = Eigen::Matrix3Xd::Random(3, 20);
  const Pose truth = random_pose();
  const Eigen::Matrix3Xd target = (2.5 * (truth.linear() * source)).colwise() + truth.translation();
  const Alignment found = align_points(source, target, true);
  EXPECT_NEAR(found.scale, 2.5, 1e-12);
  EXPECT_TRUE(found.target_from_source.isApprox(truth, 1e-12));
}

TEST(PoseMath, AlignmentOfPlanarPointsIsNoReflection) {
  Eigen::Matrix3Xd source = Eigen::Matrix3Xd::Random(3, 20);
  source.row(2).setZero();
  const Pose truth = random_pose();
  const Eigen::Matrix3Xd target = (truth.linear() * source).colwise() + truth.translation();
  EXPECT_TRUE(align_points(source, target, false).target_from_source.isApprox(truth, 1e-12));
}

}  // namespace
}  // namespace stillpoint
