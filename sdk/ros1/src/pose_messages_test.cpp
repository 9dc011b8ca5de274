#include "pose_messages.hpp"

#include <gtest/gtest.h>

namespace stillpoint_ros {
namespace {

using stillpoint::exp_se3;
using stillpoint::Matrix6d;
using stillpoint::Pose;
using stillpoint::Vector6d;

Vector6d vector6(double a, double b, double c, double d, double e, double f) {
  Vector6d vector;
  vector << a, b, c, d, e, f;
  return vector;
}

TEST(PoseMessages, GiveThePoseBack) {
  const Pose pose = exp_se3(vector6(1, -2, 3, 0.4, -0.5, 0.6));
  EXPECT_TRUE(pose_of(transform_message(pose)).isApprox(pose, 1e-12));
  EXPECT_EQ(pose_message(pose).position.z, pose.translation().z());
  EXPECT_EQ(pose_message(pose).orientation.w, transform_message(pose).rotation.w);
}

// The covariance of the base by numerical derivatives: of the map_from_base that small errors of
// the camera in its own frame give.
TEST(CovarianceMessage, IsThatOfTheBaseAboutTheAxesOfTheMap) {
  const Pose base_from_camera = exp_se3(vector6(0.3, 0.1, 1.2, -1, 0.7, 0.2));
  const Pose map_from_base = exp_se3(vector6(4, -2, 0.5, 0.3, -0.2, 2));
  const double step = 1e-6;
  Matrix6d jacobian;
  for (int i = 0; i < 6; ++i) {
    Vector6d error = Vector6d::Zero();
    error[i] = step;
    const Pose moved =
        map_from_base * base_from_camera * exp_se3(error) * base_from_camera.inverse();
    jacobian.col(i).head<3>() = (moved.translation() - map_from_base.translation()) / step;
    jacobian.col(i).tail<3>() =
        stillpoint::log_so3(moved.linear() * map_from_base.linear().transpose()) / step;
  }
  const Matrix6d root = Matrix6d::Identity() + 0.1 * Matrix6d::Ones();
  const Matrix6d in_camera = root * vector6(1, 2, 3, 0.1, 0.2, 0.3).asDiagonal() * root.transpose();
  const Matrix6d expected = jacobian * in_camera * jacobian.transpose();
  const auto message = covariance_message(in_camera, base_from_camera, map_from_base);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      EXPECT_NEAR(message[static_cast<std::size_t>(6 * row + column)], expected(row, column), 1e-4);
}

}  // namespace
}  // namespace stillpoint_ros
