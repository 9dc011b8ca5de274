// Bundle adjustment: non-linear least squares over camera poses and points.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <stop_token>
#include <vector>

#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

/// An observation of a point by a camera.
struct BundleMeasurement {
  double fx, fy, cx, cy;  ///< px
  double u, v;            ///< px
  double inverse_depth;   ///< 1/m
  double pixel_weight;    ///< 1/px: sqrt(static weight) / standard deviation
  double depth_weight;    ///< m: likewise for the inverse depth; 0 = no depth
};

/// Levenberg–Marquardt with a Huber kernel on each observation. Points are eliminated
/// by the Schur complement (Triggs et al., Bundle Adjustment: A Modern Synthesis, 2000,
/// section 6.1). Single-threaded and bitwise deterministic.
class BundleSolver {
 public:
  /// Returns the camera's number: they count from 0.
  int add_camera(const Pose& camera_from_world, bool moves);
  /// In metres. Points are numbered like cameras.
  void add_point(const Eigen::Vector3d& position_in_world);
  /// An observation of the point added last.
  void observe(int camera, const BundleMeasurement& measurement);

  /// Ends after `max_iterations`, when the cost has converged, or after the iteration in
  /// which `end_early` is requested: none, when it was before. False when there is nothing to
  /// solve.
  bool solve(int max_iterations, const std::stop_token& end_early);

  Pose camera_from_world(int camera) const;
  const Eigen::Vector3d& point(std::size_t index) const { return points_[index]; }

 private:
  using Matrix63d = Eigen::Matrix<double, 6, 3>;
  using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  struct Camera {
    Eigen::Matrix3d rotation;  // of camera_from_world, with the translation
    Eigen::Vector3d translation;
    int column;  // among the optimised cameras; -1: fixed
  };
  struct Observation {
    int camera;
    BundleMeasurement measurement;
  };
  // Normal equations: diagonal blocks of points and of cameras.
  struct PointPart {
    Eigen::Matrix3d hessian;
    Eigen::Vector3d gradient;
  };
  struct CameraPart {
    Matrix6d hessian;
    Vector6d gradient;
  };
  struct Step {
    Eigen::Matrix3Xd points;
    Matrix6Xd cameras;
  };
  // 6 x 6 block of the reduced system, in the lower triangle.
  struct Block {
    int row, column;
    Matrix6d value;
  };

  void find_blocks();
  double cost() const;
  void linearise();
  bool solve_damped(double damping, Step& step);
  void reduce(double damping, Eigen::VectorXd& right_side);
  bool solve_reduced(const Eigen::VectorXd& right_side, Matrix6Xd& cameras) const;
  double expected_decrease(double damping, const Step& step) const;
  void apply(const Step& step);

  template <typename Visit>
  void for_each_pair(std::size_t point, Visit visit) const;

  std::vector<Camera> cameras_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::size_t> first_observation_;  // of each point
  std::vector<Observation> observations_;
  int moving_count_ = 0;

  std::vector<Block> blocks_;
  std::vector<int> block_of_pair_;  // in the order of for_each_pair over all points
  std::vector<PointPart> point_parts_;
  std::vector<CameraPart> camera_parts_;
  std::vector<Matrix63d> cross_blocks_;  // of each observation: camera rows, point columns
  std::vector<Eigen::Matrix3d> inverse_point_hessians_;
};

}  // namespace stillpoint::orb_slam
