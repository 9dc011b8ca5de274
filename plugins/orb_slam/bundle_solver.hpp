// Least squares over camera poses and points.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <stop_token>
#include <vector>

#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

/// What a camera saw of a point.
struct BundleMeasurement {
  double fx, fy, cx, cy;  ///< px
  double u, v;            ///< px
  double inverse_depth;   ///< 1/m
  double pixel_weight;    ///< 1/px: one over the standard deviation, times the root of the trust
  double depth_weight;    ///< m: the same of the inverse depth; 0 = no depth
};

/// Levenberg and Marquardt's method with a Huber kernel on each observation. Points are eliminated
/// by the Schur complement (Triggs et al., Bundle Adjustment: A Modern Synthesis, 2000,
/// section 6.1). One thread, the same bits every time.
class BundleSolver {
 public:
  /// Returns the camera's number: they count from 0.
  int add_camera(const Pose& camera_from_world, bool moves);
  /// In metres. Points are numbered like cameras.
  void add_point(const Eigen::Vector3d& position_in_world);
  /// An observation of the point added last.
  void observe(int camera, const BundleMeasurement& measurement);

  /// Ends after `max_iterations`, when the error hardly falls any more, or after the iteration in
  /// which `hurry` is requested: none, when it was before. False when there is nothing to solve.
  bool solve(int max_iterations, const std::stop_token& hurry);

  Pose camera_from_world(int camera) const;
  const Eigen::Vector3d& point(std::size_t index) const { return points_[index]; }

 private:
  using Matrix63d = Eigen::Matrix<double, 6, 3>;
  using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  struct Camera {
    Eigen::Matrix3d rotation;  // of camera_from_world, with the translation
    Eigen::Vector3d translation;
    int column;  // among those that move; -1: stays
  };
  struct Observation {
    int camera;
    BundleMeasurement measurement;
  };
  // Normal equations, points' and cameras' parts apart.
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
  std::vector<Matrix63d> mixed_parts_;  // of each observation, by camera and point
  std::vector<Eigen::Matrix3d> inverse_point_hessians_;
};

}  // namespace stillpoint::orb_slam
