#include "stillpoint/support/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace stillpoint {
namespace {

class RigidMotionTest : public ::testing::Test {
 protected:
  // `count` points that follow `motion`, measured with noise.
  void add(int count, const Pose& motion, double weight = 1.0, double plane = 0) {
    while (count > 0) {
      const double z = plane > 0 ? plane : uniform(1, 5);
      const Eigen::Vector3d p = camera_.unproject(uniform(20, 620), uniform(20, 460), z);
      const Eigen::Vector3d q = motion * p;
      const Eigen::Vector2d pixel =
          camera_.project(q) + noise_.pixel * Eigen::Vector2d(normal(), normal());
      if (!camera_.contains(pixel.x(), pixel.y())) continue;
      const double inverse = 1 / q.z() + noise_.inverse_depth * normal();
      matches_.push_back({p, camera_.unproject(pixel.x(), pixel.y(), 1 / inverse), pixel, weight});
      --count;
    }
  }
  std::optional<RigidMotion> find(std::span<const Pose> guesses = {}, std::uint64_t seed = 1) {
    return find_rigid_motion(matches_, camera_, kAssumed, guesses, 60, seed);
  }
  static void expect_near(const Pose& a, const Pose& b) {
    EXPECT_LT((a.inverse() * b).translation().norm(), 0.003);
    EXPECT_LT(rotation_angle(a.inverse() * b), 0.001);
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }
  double normal() { return std::normal_distribution<>()(random_); }

  static constexpr RigidNoise kAssumed{.pixel = 0.4, .inverse_depth = 0.004};
  std::mt19937_64 random_{7};
  Camera camera_;
  RigidNoise noise_{.pixel = 0.2, .inverse_depth = 0.001};  // of the measurements
  std::vector<RigidMatch> matches_;
  Pose motion_ = exp_se3((Vector6d() << 0.05, -0.02, 0.04, 0.01, 0.03, -0.02).finished());
  Pose other_ = exp_se3((Vector6d() << -0.2, 0.03, 0.02, 0, 0.02, 0.05).finished());
};

TEST_F(RigidMotionTest, IsFoundAmongOutliers) {
  add(120, motion_);
  add(60, other_);
  const auto found = find();
  ASSERT_TRUE(found);
  expect_near(found->target_from_source, motion_);
  EXPECT_NEAR(found->inliers, 120, 12);
  EXPECT_NEAR(found->agreement, 0.67, 0.07);
}

TEST_F(RigidMotionTest, IsFoundFromOnePlaneAndForPureRotation) {
  add(100, motion_, 1.0, 3.0);
  expect_near(find()->target_from_source, motion_);
  matches_.clear();
  Pose rotation = motion_;
  rotation.translation().setZero();
  add(100, rotation);
  expect_near(find()->target_from_source, rotation);
}

TEST_F(RigidMotionTest, WeightsDecideBetweenTwoMotions) {
  add(80, motion_, 0.9);
  add(160, other_, 0.2);
  expect_near(find()->target_from_source, motion_);
}

TEST_F(RigidMotionTest, LargeMotionsAreFoundToo) {
  const Pose large = exp_se3((Vector6d() << 0.4, 0.1, -0.3, 0.1, -0.25, 0.1).finished());
  add(150, large);
  add(50, other_);
  expect_near(find()->target_from_source, large);
}

TEST_F(RigidMotionTest, SameSeedSameMotion) {
  add(90, motion_);
  add(60, other_);
  EXPECT_EQ(find({}, 5)->target_from_source.matrix(), find({}, 5)->target_from_source.matrix());
}

TEST_F(RigidMotionTest, NothingIsDeterminedByTooFewOrCrowdedMatches) {
  EXPECT_FALSE(find());
  add(2, motion_);
  EXPECT_FALSE(find());
  const RigidMatch one = matches_.front();
  matches_.assign(50, one);
  EXPECT_FALSE(find());
}

TEST_F(RigidMotionTest, UncertaintyGrowsWithFewerMatches) {
  add(20, motion_);
  const double few = pixel_uncertainty(*find(), camera_, {0, 0, 2});
  add(400, motion_);
  const double many = pixel_uncertainty(*find(), camera_, {0, 0, 2});
  EXPECT_LT(many, few / 3);
  EXPECT_GT(many, 0);
}

// The squared error in standard deviations has a mean of 5.4: six for least squares; the biweight
// counts residuals for less and takes the motion for less certain than it is.
TEST_F(RigidMotionTest, UncertaintyIsThatOfItsErrors) {
  constexpr int kTrials = 300;
  noise_ = kAssumed;
  double sum = 0;
  for (int i = 0; i < kTrials; ++i) {
    matches_.clear();
    add(120, motion_);
    const auto found = find({&motion_, 1});
    ASSERT_TRUE(found);
    const Vector6d error = log_se3(found->target_from_source * motion_.inverse());
    sum += error.dot(found->covariance.inverse() * error);
  }
  EXPECT_NEAR(sum / kTrials, 5.4, 1.2);
}

}  // namespace
}  // namespace stillpoint
