// Pose of a camera from landmarks of known position.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/options.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

/// A landmark and where it was measured.
struct PoseObservation {
  Eigen::Vector3d point_in_world;    ///< metres
  Eigen::Vector2d pixel;             ///< px
  double inverse_depth = 0.0;        ///< 1/m; 0 = not measured
  double pixel_sigma = 1.0;          ///< px, standard deviation
  double inverse_depth_sigma = 1.0;  ///< 1/m, standard deviation
  double weight = 1.0;               ///< probability that the point is static, 0 … 1
  bool temporary = false;            ///< known from the frame before only
};

/// A sum of squared, normalised residuals near a pose, of the twist that perturbs camera_from_world
/// on the left: constant + 2 gradient·twist + twist·hessian·twist.
struct QuadraticCost {
  Pose linearised_at = Pose::Identity();  ///< camera_from_world
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double constant = 0.0;

  /// The same, linearised elsewhere nearby.
  QuadraticCost moved_to(const Pose& camera_from_world) const;
};
/// Both must be linearised at the same pose.
QuadraticCost operator+(const QuadraticCost& a, const QuadraticCost& b);
/// Additional cost on the pose, linearised at camera_from_world; evaluated once per round, from 0.
using PoseTerm = std::function<QuadraticCost(const Pose& camera_from_world, int round)>;

struct PoseSolution {
  Pose camera_from_world = Pose::Identity();
  /// Of the camera in its own frame, translation, then rotation; and the part of temporary points.
  Matrix6d information = Matrix6d::Zero();
  Matrix6d temporary_information = Matrix6d::Zero();
  std::vector<bool> inlier;  ///< per observation
  int inliers = 0;
};

/// Levenberg–Marquardt on the six degrees of freedom of the pose over reprojection and inverse
/// depth, in rounds: the first ones with a Huber kernel, each followed by outlier rejection with
/// the 95 % bounds of the chi-square distribution. The noise of a structured-light
/// sensor is constant in inverse depth, which keeps that term close to linear.
PoseSolution solve_pose(std::span<const PoseObservation> observations, const Camera& camera,
                        const Pose& camera_from_world_guess);

/// The same with a further term, which constrains the pose also where observations are too few.
PoseSolution solve_pose(std::span<const PoseObservation> observations, const Camera& camera,
                        const Pose& camera_from_world_guess, const PoseTerm& term);

/// 95 % bounds of the squared, normalised error with two and three measurements.
inline constexpr double kChiSquare2 = 5.991;
inline constexpr double kChiSquare3 = 7.815;

}  // namespace stillpoint::orb_slam
