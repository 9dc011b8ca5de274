// Pose of a camera from landmarks of known position.
#pragma once

#include <span>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/options.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb {

/// A landmark and where it was measured.
struct PoseObservation {
  Eigen::Vector3d point_in_world;    ///< metres
  Eigen::Vector2d pixel;             ///< px
  double inverse_depth = 0.0;        ///< 1/m; 0 = not measured
  double pixel_sigma = 1.0;          ///< px, standard deviation
  double inverse_depth_sigma = 1.0;  ///< 1/m, standard deviation
  double weight = 1.0;               ///< probability that the point is static, 0 … 1
};

struct PoseSolution {
  Pose camera_from_world = Pose::Identity();
  std::vector<bool> inlier;  ///< per observation
  int inliers = 0;
};

/// Levenberg–Marquardt on the six degrees of freedom of the pose over reprojection and inverse
/// depth, in rounds: the first ones with a Huber kernel, each followed by a new decision on who is
/// an outlier by the 95 % bounds of the chi-square distribution. The noise of a structured-light
/// sensor is constant in inverse depth, which keeps that term close to linear.
PoseSolution solve_pose(std::span<const PoseObservation> observations, const Camera& camera,
                        const Pose& camera_from_world_guess);

/// 95 % bounds of the squared, normalised error with two and three measurements.
inline constexpr double kChiSquare2 = 5.991;
inline constexpr double kChiSquare3 = 7.815;

}  // namespace stillpoint::orb
