#include "stillpoint/contracts/pose_uncertainty.hpp"

#include <gtest/gtest.h>

namespace stillpoint {
namespace {

TEST(PoseUncertainty, ItsFiguresAreThoseOfTheWorstDirection) {
  PoseUncertainty uncertainty{.covariance = 1e-6 * Matrix6d::Identity()};
  EXPECT_NEAR(uncertainty.metres(), 1e-3, 1e-12);
  EXPECT_FALSE(uncertainty.poorly_constrained());
  // Free along (1, 1, 0), however well each axis by itself may seem to be known.
  const Eigen::Vector3d free = Eigen::Vector3d(1, 1, 0).normalized();
  uncertainty.covariance.topLeftCorner<3, 3>() += 0.2 * 0.2 * free * free.transpose();
  EXPECT_NEAR(uncertainty.metres(), 0.2, 1e-4);
  EXPECT_NEAR(uncertainty.radians(), 1e-3, 1e-12);
  EXPECT_TRUE(uncertainty.poorly_constrained());
}

TEST(PoseUncertainty, NothingMeasuredIsPoorlyConstrained) {
  EXPECT_TRUE(PoseUncertainty().poorly_constrained());
  EXPECT_FALSE(PoseUncertainty{.covariance = Matrix6d::Zero()}.poorly_constrained());
}

}  // namespace
}  // namespace stillpoint
