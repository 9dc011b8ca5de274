#include "orb_slam/pose_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace stillpoint::orb_slam {
namespace {

constexpr int kRounds = 4;
constexpr int kTermRounds = 6;    // with a further term, which is linearised anew in each
constexpr int kRobustRounds = 2;  // with the Huber kernel; later ones rely on outlier rejection
constexpr int kIterationsPerRound = 6;
constexpr double kConverged = 1e-6;  // metres and radians
constexpr int kMinObservations = 6;
constexpr double kMinPointDepth = 0.05;  // metres in front of the camera

struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Matrix6d temporary = Matrix6d::Zero();  // the part of temporary points
  Vector6d gradient = Vector6d::Zero();
  double cost = 0.0;
};

// Adds the hessian of a point to that of the twist that moves it; the upper right block is left
// out. d p / d (translation, rotation) = [I, -skew(p)] for a perturbation on the left, so that the
// blocks are A, skew(p) A and skew(p) A skew(p)^T: cross products, a third of the work of a 3 x 6
// Jacobian.
void add_moved_point(const Eigen::Vector3d& p, const Eigen::Matrix3d& point, Matrix6d& twist) {
  Eigen::Matrix3d turned;
  for (int i = 0; i < 3; ++i) turned.col(i) = p.cross(point.col(i));
  twist.topLeftCorner<3, 3>() += point;
  twist.bottomLeftCorner<3, 3>() += turned;
  for (int i = 0; i < 3; ++i) twist.block<3, 1>(3, 3 + i) += p.cross(turned.row(i).transpose());
}

void complete(Matrix6d& symmetric) {
  symmetric.topRightCorner<3, 3>() = symmetric.bottomLeftCorner<3, 3>().transpose();
}

double bound(const PoseObservation& o) { return o.inverse_depth > 0 ? kChiSquare3 : kChiSquare2; }

// Normalised residual (u, v, inverse depth); infinite error behind the camera.
bool residual(const PoseObservation& o, const Camera& camera, const Eigen::Vector3d& p,
              Eigen::Vector3d& r) {
  if (p.z() < kMinPointDepth) return false;
  const double inverse_z = 1.0 / p.z();
  r.x() = (camera.fx * p.x() * inverse_z + camera.cx - o.pixel.x()) / o.pixel_sigma;
  r.y() = (camera.fy * p.y() * inverse_z + camera.cy - o.pixel.y()) / o.pixel_sigma;
  r.z() = o.inverse_depth > 0 ? (inverse_z - o.inverse_depth) / o.inverse_depth_sigma : 0.0;
  return true;
}

double huber_cost(double squared, double limit) {
  return squared <= limit ? squared : 2.0 * std::sqrt(squared * limit) - limit;
}

class Solver {
 public:
  Solver(std::span<const PoseObservation> observations, const Camera& camera, const Pose& guess,
         const PoseTerm& term)
      : observations_(observations), camera_(camera), term_(term) {
    solution_.camera_from_world = guess;
    solution_.inlier.assign(observations.size(), true);
    solution_.inliers = static_cast<int>(observations.size());
  }

  PoseSolution run() {
    const int rounds = term_ ? kTermRounds : kRounds;
    for (int round = 0; round < rounds && enough(); ++round) {
      robust_ = round < kRobustRounds;
      if (term_) further_ = term_(solution_.camera_from_world, round);
      iterate();
      const bool changed = classify();
      if (!robust_ && !changed && !term_) break;
    }
    return std::move(solution_);
  }

 private:
  bool enough() const { return term_ || solution_.inliers >= kMinObservations; }

  void iterate() {
    double lambda = 1e-4;
    NormalEquations current = build(solution_.camera_from_world);
    for (int i = 0; i < kIterationsPerRound; ++i) {
      Matrix6d damped = current.hessian;
      damp(damped, lambda);
      const Vector6d step = damped.ldlt().solve(-current.gradient);
      if (!step.allFinite()) break;
      const Pose candidate = exp_se3(step) * solution_.camera_from_world;
      NormalEquations next = build(candidate);
      if (next.cost <= current.cost) {
        solution_.camera_from_world = candidate;
        current = std::move(next);
        lambda *= 0.1;
        if (step.norm() < kConverged) break;
      } else {
        lambda = std::max(lambda, 1e-6) * 10.0;
      }
    }
    solution_.information = current.hessian;
    solution_.temporary_information = current.temporary;
  }

  // Directions that a term leaves unconstrained need not be axis-aligned: only isotropic damping
  // keeps the step from moving along them.
  void damp(Matrix6d& hessian, double lambda) const {
    if (term_)
      hessian.diagonal().array() += 1e-2 * lambda * hessian.diagonal().mean();
    else
      hessian.diagonal() *= 1.0 + lambda;
  }

  NormalEquations build(const Pose& camera_from_world) const {
    NormalEquations n;
    for (std::size_t i = 0; i < observations_.size(); ++i)
      if (solution_.inlier[i]) add(observations_[i], camera_from_world, n);
    complete(n.hessian);
    complete(n.temporary);
    if (term_) add(further_, camera_from_world, n);
    return n;
  }

  static void add(const QuadraticCost& q, const Pose& camera_from_world, NormalEquations& n) {
    const QuadraticCost here = q.moved_to(camera_from_world);
    n.hessian += here.hessian;
    n.gradient += here.gradient;
    n.cost += here.constant;
  }

  void add(const PoseObservation& o, const Pose& camera_from_world, NormalEquations& n) const {
    const Eigen::Vector3d p = camera_from_world * o.point_in_world;
    Eigen::Vector3d r;
    const double limit = bound(o);
    if (!residual(o, camera_, p, r)) {
      n.cost += o.weight * limit;
      return;
    }
    const double squared = r.squaredNorm();
    double weight = o.weight;
    n.cost += o.weight * (robust_ ? huber_cost(squared, limit) : squared);
    if (robust_ && squared > limit) weight *= std::sqrt(limit / squared);

    Eigen::Matrix3d by_point = camera_.measurement_jacobian(p);
    by_point.topRows<2>() *= 1.0 / o.pixel_sigma;
    by_point(2, 2) = o.inverse_depth > 0 ? by_point(2, 2) / o.inverse_depth_sigma : 0.0;
    const Eigen::Matrix3d hessian = weight * (by_point.transpose() * by_point);
    const Eigen::Vector3d gradient = weight * (by_point.transpose() * r);
    add_moved_point(p, hessian, n.hessian);
    if (o.temporary) add_moved_point(p, hessian, n.temporary);
    n.gradient.head<3>() += gradient;
    n.gradient.tail<3>() += p.cross(gradient);
  }

  // Marks inliers by the chi-square test; returns whether any has changed.
  bool classify() {
    bool changed = false;
    solution_.inliers = 0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      const PoseObservation& o = observations_[i];
      Eigen::Vector3d r;
      const bool visible = residual(o, camera_, solution_.camera_from_world * o.point_in_world, r);
      const bool fits = visible && r.squaredNorm() <= bound(o);
      changed |= fits != solution_.inlier[i];
      solution_.inlier[i] = fits;
      solution_.inliers += fits;
    }
    return changed;
  }

  std::span<const PoseObservation> observations_;
  const Camera& camera_;
  const PoseTerm& term_;
  QuadraticCost further_;  // the term, this round
  PoseSolution solution_;
  bool robust_ = true;
};

}  // namespace

QuadraticCost QuadraticCost::moved_to(const Pose& camera_from_world) const {
  const Vector6d twist = log_se3(camera_from_world * linearised_at.inverse());
  const Vector6d slope = hessian * twist;
  return {.linearised_at = camera_from_world,
          .hessian = hessian,
          .gradient = gradient + slope,
          .constant = constant + twist.dot(2.0 * gradient + slope)};
}

QuadraticCost operator+(const QuadraticCost& a, const QuadraticCost& b) {
  return {.linearised_at = a.linearised_at,
          .hessian = a.hessian + b.hessian,
          .gradient = a.gradient + b.gradient,
          .constant = a.constant + b.constant};
}

PoseSolution solve_pose(std::span<const PoseObservation> observations, const Camera& camera,
                        const Pose& camera_from_world_guess) {
  return solve_pose(observations, camera, camera_from_world_guess, {});
}

PoseSolution solve_pose(std::span<const PoseObservation> observations, const Camera& camera,
                        const Pose& camera_from_world_guess, const PoseTerm& term) {
  return Solver(observations, camera, camera_from_world_guess, term).run();
}

}  // namespace stillpoint::orb_slam
