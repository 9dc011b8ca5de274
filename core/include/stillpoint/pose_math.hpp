// Rigid transforms. A pose `target_from_source` maps points: x_in_target = target_from_source *
// x_in_source. Tangent vectors are (translation, rotation), both in the target frame:
// perturbed = exp_se3(delta) * pose.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "stillpoint/export.hpp"

namespace stillpoint {

using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A pose of a trajectory.
struct StampedPose {
  double time = 0.0;  ///< seconds
  Pose world_from_camera = Pose::Identity();
};

/// Cross-product matrix: skew(a) * b = a × b.
STILLPOINT_EXPORT Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Rotation matrix of a rotation vector (radians).
STILLPOINT_EXPORT Eigen::Matrix3d exp_so3(const Eigen::Vector3d& rotation);

/// Rotation vector (radians, norm <= pi) of a rotation matrix.
STILLPOINT_EXPORT Eigen::Vector3d log_so3(const Eigen::Matrix3d& rotation);

/// Exponential map of SE(3); `twist` = (translation part in metres, rotation part in radians).
STILLPOINT_EXPORT Pose exp_se3(const Vector6d& twist);

/// Inverse of exp_se3.
STILLPOINT_EXPORT Vector6d log_se3(const Pose& pose);

/// The same pose with its rotation made orthonormal again; products of many poses drift away.
STILLPOINT_EXPORT Pose orthonormalised(const Pose& pose);

/// Pose at fraction `t` in [0, 1] of the way from `a` to `b`: linear in translation, slerp in
/// rotation.
STILLPOINT_EXPORT Pose interpolate(const Pose& a, const Pose& b, double t);

/// Rotation angle in radians of a pose.
STILLPOINT_EXPORT double rotation_angle(const Pose& pose);

/// Least-squares rigid or similarity alignment (Umeyama 1991): target ~ scale * R * source + t.
struct Alignment {
  Pose target_from_source = Pose::Identity();
  double scale = 1.0;
};
/// Both matrices hold one point per column (3 x N, N >= 1). Without `with_scale`, scale is 1.
STILLPOINT_EXPORT Alignment align_points(const Eigen::Matrix3Xd& source,
                                         const Eigen::Matrix3Xd& target, bool with_scale);

}  // namespace stillpoint
