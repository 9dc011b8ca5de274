#include "stillpoint/pose_math.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace stillpoint {
namespace {

constexpr double kSmallAngle = 1e-8;  // radians; below it the series' first terms are exact

// Left Jacobian of SO(3) (Barfoot, State Estimation for Robotics, eq. 7.77b).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Matrix3d k = skew(rotation);
  if (angle < 1e-5) return Eigen::Matrix3d::Identity() + 0.5 * k + k * k / 6.0;
  const double angle2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / angle2 * k +
         (angle - std::sin(angle)) / (angle2 * angle) * k * k;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + skew(rotation);
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Eigen::Vector3d log_so3(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double half_sine = q.vec().norm();
  if (half_sine < kSmallAngle) return 2.0 * q.vec();
  return 2.0 * std::atan2(half_sine, q.w()) / half_sine * q.vec();
}

Pose exp_se3(const Vector6d& twist) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(twist.tail<3>());
  pose.translation() = left_jacobian(twist.tail<3>()) * twist.head<3>();
  return pose;
}

Vector6d log_se3(const Pose& pose) {
  Vector6d twist;
  twist.tail<3>() = log_so3(pose.linear());
  twist.head<3>() = left_jacobian(twist.tail<3>()).inverse() * pose.translation();
  return twist;
}

Pose orthonormalised(const Pose& pose) {
  Pose result = pose;
  result.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return result;
}

Pose interpolate(const Pose& a, const Pose& b, double t) {
  Pose result = Pose::Identity();
  result.linear() =
      Eigen::Quaterniond(a.linear()).slerp(t, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  result.translation() = (1.0 - t) * a.translation() + t * b.translation();
  return result;
}

double rotation_angle(const Pose& pose) {
  // The trace can leave [-1, 3] by rounding.
  return std::acos(std::clamp((pose.linear().trace() - 1.0) / 2.0, -1.0, 1.0));
}

Alignment align_points(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target,
                       bool with_scale) {
  const Eigen::Vector3d source_mean = source.rowwise().mean();
  const Eigen::Vector3d target_mean = target.rowwise().mean();
  const Eigen::Matrix3Xd source_centred = source.colwise() - source_mean;
  const Eigen::Matrix3Xd target_centred = target.colwise() - target_mean;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(target_centred * source_centred.transpose(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;

  Alignment result;
  result.target_from_source.linear() =
      svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const double source_variance = source_centred.squaredNorm();
  if (with_scale && source_variance > 0)
    result.scale = svd.singularValues().dot(signs) / source_variance;
  result.target_from_source.translation() =
      target_mean - result.scale * (result.target_from_source.linear() * source_mean);
  return result;
}

}  // namespace stillpoint
