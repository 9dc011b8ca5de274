#include "orb_slam/bundle_solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "orb_slam/pose_solver.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr double kMinDepth = 0.05;  // metres; nearer points give no residual
constexpr double kFirstDamping = 1e-4;
constexpr double kMinGainRatio = 1e-3;         // actual over expected decrease of the cost
constexpr double kMinRelativeDecrease = 1e-6;  // of the cost, relative
constexpr double kSmallestDiagonal = 1e-6;     // that damping is relative to

struct Residual {
  Eigen::Vector3d value;
  Eigen::Matrix3d by_point_in_camera;
};

bool evaluate(const BundleMeasurement& m, const Eigen::Vector3d& p, Eigen::Vector3d& r) {
  if (p.z() < kMinDepth) return false;
  const double iz = 1.0 / p.z();
  r = {m.pixel_weight * (m.fx * p.x() * iz + m.cx - m.u),
       m.pixel_weight * (m.fy * p.y() * iz + m.cy - m.v), m.depth_weight * (iz - m.inverse_depth)};
  return true;
}

void differentiate(const BundleMeasurement& m, const Eigen::Vector3d& p, Eigen::Matrix3d& d) {
  const double iz = 1.0 / p.z();
  d << m.pixel_weight * m.fx * iz, 0, -m.pixel_weight * m.fx * p.x() * iz * iz,  //
      0, m.pixel_weight * m.fy * iz, -m.pixel_weight * m.fy * p.y() * iz * iz,   //
      0, 0, -m.depth_weight * iz * iz;
}

// Huber's kernel at a squared error: twice the cost, and the weight of the observation.
double huber_cost(double square) {
  return square <= kChiSquare3 ? square : 2 * std::sqrt(kChiSquare3 * square) - kChiSquare3;
}
double huber_weight(double square) {
  return square <= kChiSquare3 ? 1.0 : std::sqrt(kChiSquare3 / square);
}

template <typename Matrix>
Matrix damped(const Matrix& hessian, double damping) {
  Matrix result = hessian;
  result.diagonal() += damping * hessian.diagonal().cwiseMax(kSmallestDiagonal);
  return result;
}

}  // namespace

int BundleSolver::add_camera(const Pose& camera_from_world, bool moves) {
  cameras_.push_back(
      {camera_from_world.linear(), camera_from_world.translation(), moves ? moving_count_++ : -1});
  return static_cast<int>(cameras_.size()) - 1;
}

void BundleSolver::add_point(const Eigen::Vector3d& position_in_world) {
  points_.push_back(position_in_world);
  first_observation_.push_back(observations_.size());
}

void BundleSolver::observe(int camera, const BundleMeasurement& measurement) {
  observations_.push_back({camera, measurement});
}

Pose BundleSolver::camera_from_world(int camera) const {
  Pose pose = Pose::Identity();
  pose.linear() = cameras_[static_cast<std::size_t>(camera)].rotation;
  pose.translation() = cameras_[static_cast<std::size_t>(camera)].translation;
  return pose;
}

// Calls visit(first, second) for observations of a point by optimised cameras, each pair once and
// each with itself; the first camera's column is not before the second's.
template <typename Visit>
void BundleSolver::for_each_pair(std::size_t point, Visit visit) const {
  const std::size_t end = first_observation_[point + 1];
  for (std::size_t a = first_observation_[point]; a < end; ++a) {
    const int column_a = cameras_[static_cast<std::size_t>(observations_[a].camera)].column;
    if (column_a < 0) continue;
    for (std::size_t b = first_observation_[point]; b <= a; ++b) {
      const int column_b = cameras_[static_cast<std::size_t>(observations_[b].camera)].column;
      if (column_b < 0) continue;
      column_a >= column_b ? visit(a, b) : visit(b, a);
    }
  }
}

void BundleSolver::find_blocks() {
  blocks_.clear();
  block_of_pair_.clear();
  std::unordered_map<std::int64_t, int> known;
  const auto block_at = [&](int row, int column) {
    const auto [found, is_new] = known.try_emplace(std::int64_t{row} * moving_count_ + column,
                                                   static_cast<int>(blocks_.size()));
    if (is_new) blocks_.push_back({row, column, Matrix6d::Zero()});
    return found->second;
  };
  for (int i = 0; i < moving_count_; ++i) block_at(i, i);
  for (std::size_t point = 0; point < points_.size(); ++point)
    for_each_pair(point, [&](std::size_t a, std::size_t b) {
      block_of_pair_.push_back(
          block_at(cameras_[static_cast<std::size_t>(observations_[a].camera)].column,
                   cameras_[static_cast<std::size_t>(observations_[b].camera)].column));
    });
}

double BundleSolver::cost() const {
  double sum = 0;
  Eigen::Vector3d r;
  for (std::size_t point = 0; point < points_.size(); ++point)
    for (std::size_t i = first_observation_[point]; i < first_observation_[point + 1]; ++i) {
      const Camera& camera = cameras_[static_cast<std::size_t>(observations_[i].camera)];
      const Eigen::Vector3d p = camera.rotation * points_[point] + camera.translation;
      // Behind the camera, too, it costs something: else that would be the way out of every error.
      sum +=
          evaluate(observations_[i].measurement, p, r) ? huber_cost(r.squaredNorm()) : kChiSquare3;
    }
  return 0.5 * sum;
}

void BundleSolver::linearise() {
  point_parts_.assign(points_.size(), {Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()});
  camera_parts_.assign(static_cast<std::size_t>(moving_count_),
                       {Matrix6d::Zero(), Vector6d::Zero()});
  Residual residual;
  Eigen::Matrix<double, 3, 6> by_camera;
  for (std::size_t point = 0; point < points_.size(); ++point)
    for (std::size_t i = first_observation_[point]; i < first_observation_[point + 1]; ++i) {
      const auto& [number, m] = observations_[i];
      const Camera& camera = cameras_[static_cast<std::size_t>(number)];
      const Eigen::Vector3d turned = camera.rotation * points_[point];
      const Eigen::Vector3d p = turned + camera.translation;
      cross_blocks_[i].setZero();
      if (!evaluate(m, p, residual.value)) continue;
      differentiate(m, p, residual.by_point_in_camera);
      const double weight = huber_weight(residual.value.squaredNorm());
      const Eigen::Matrix3d by_point = residual.by_point_in_camera * camera.rotation;
      const Eigen::Matrix3d weighted = weight * by_point;
      point_parts_[point].hessian.noalias() += weighted.transpose() * by_point;
      point_parts_[point].gradient.noalias() += weighted.transpose() * residual.value;
      if (camera.column < 0) continue;
      // The rotation is changed from the left: d(exp(w) R x)/dw = -skew(R x).
      by_camera.leftCols<3>() = residual.by_point_in_camera;
      by_camera.rightCols<3>().noalias() = -residual.by_point_in_camera * skew(turned);
      CameraPart& part = camera_parts_[static_cast<std::size_t>(camera.column)];
      part.hessian.noalias() += weight * by_camera.transpose() * by_camera;
      part.gradient.noalias() += weight * by_camera.transpose() * residual.value;
      cross_blocks_[i].noalias() = by_camera.transpose() * weighted;
    }
}

// Reduced camera system: the points are eliminated by the Schur complement.
void BundleSolver::reduce(double damping, Eigen::VectorXd& right_side) {
  for (Block& block : blocks_) block.value.setZero();
  right_side.resize(6 * moving_count_);
  for (int i = 0; i < moving_count_; ++i) {  // the blocks of a camera with itself come first
    const CameraPart& part = camera_parts_[static_cast<std::size_t>(i)];
    blocks_[static_cast<std::size_t>(i)].value = damped(part.hessian, damping);
    right_side.segment<6>(6 * i) = -part.gradient;
  }
  std::size_t pair = 0;
  for (std::size_t point = 0; point < points_.size(); ++point) {
    Eigen::Matrix3d& inverse = inverse_point_hessians_[point];
    inverse = damped(point_parts_[point].hessian, damping).inverse();
    const Eigen::Vector3d best = inverse * point_parts_[point].gradient;
    std::size_t last = observations_.size();
    Matrix63d scaled;
    for_each_pair(point, [&](std::size_t a, std::size_t b) {
      if (a != last) scaled.noalias() = cross_blocks_[a] * inverse;
      last = a;
      blocks_[static_cast<std::size_t>(block_of_pair_[pair++])].value.noalias() -=
          scaled * cross_blocks_[b].transpose();
      if (a == b) {
        const int column = cameras_[static_cast<std::size_t>(observations_[a].camera)].column;
        right_side.segment<6>(6 * column).noalias() += cross_blocks_[a] * best;
      }
    });
  }
}

bool BundleSolver::solve_reduced(const Eigen::VectorXd& right_side, Matrix6Xd& cameras) const {
  cameras.resize(6, moving_count_);
  if (moving_count_ == 0) return true;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(36 * blocks_.size());
  for (const Block& block : blocks_)
    for (int column = 0; column < 6; ++column)
      for (int row = block.row == block.column ? column : 0; row < 6; ++row)
        entries.emplace_back(6 * block.row + row, 6 * block.column + column,
                             block.value(row, column));
  Eigen::SparseMatrix<double> lower(6 * moving_count_, 6 * moving_count_);
  lower.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(lower);
  if (solver.info() != Eigen::Success) return false;
  const Eigen::VectorXd solution = solver.solve(right_side);
  cameras = Eigen::Map<const Matrix6Xd>(solution.data(), 6, moving_count_);
  return cameras.allFinite();
}

bool BundleSolver::solve_damped(double damping, Step& step) {
  Eigen::VectorXd right_side;
  reduce(damping, right_side);
  if (!solve_reduced(right_side, step.cameras)) return false;
  step.points.resize(3, static_cast<Eigen::Index>(points_.size()));
  for (std::size_t point = 0; point < points_.size(); ++point) {
    Eigen::Vector3d sum = -point_parts_[point].gradient;
    for (std::size_t i = first_observation_[point]; i < first_observation_[point + 1]; ++i)
      if (const int column = cameras_[static_cast<std::size_t>(observations_[i].camera)].column;
          column >= 0)
        sum.noalias() -= cross_blocks_[i].transpose() * step.cameras.col(column);
    step.points.col(static_cast<Eigen::Index>(point)).noalias() =
        inverse_point_hessians_[point] * sum;
  }
  return step.points.allFinite();
}

// Of the cost, by the linear model: (damping * step' D step - gradient' step) / 2.
double BundleSolver::expected_decrease(double damping, const Step& step) const {
  double sum = 0;
  const auto add = [&](const auto& part, const auto& change) {
    const auto diagonal = part.hessian.diagonal().cwiseMax(kSmallestDiagonal);
    sum += damping * change.cwiseAbs2().dot(diagonal) - change.dot(part.gradient);
  };
  for (std::size_t i = 0; i < point_parts_.size(); ++i)
    add(point_parts_[i], step.points.col(static_cast<Eigen::Index>(i)));
  for (std::size_t i = 0; i < camera_parts_.size(); ++i)
    add(camera_parts_[i], step.cameras.col(static_cast<Eigen::Index>(i)));
  return 0.5 * sum;
}

void BundleSolver::apply(const Step& step) {
  for (std::size_t i = 0; i < points_.size(); ++i)
    points_[i] += step.points.col(static_cast<Eigen::Index>(i));
  for (Camera& camera : cameras_) {
    if (camera.column < 0) continue;
    const auto change = step.cameras.col(camera.column);
    camera.translation += change.head<3>();
    camera.rotation = exp_so3(change.tail<3>()) * camera.rotation;
  }
}

bool BundleSolver::solve(int max_iterations, const std::stop_token& end_early) {
  if (observations_.empty()) return false;
  first_observation_.push_back(observations_.size());
  find_blocks();
  cross_blocks_.resize(observations_.size());
  inverse_point_hessians_.resize(points_.size());
  double damping = kFirstDamping, growth = 2, current = cost();
  bool moved = true;
  Step step;
  for (int i = 0; i < max_iterations && current > 0 && !end_early.stop_requested(); ++i) {
    if (moved) linearise();
    moved = false;
    const bool solved = solve_damped(damping, step);
    const double expected = solved ? expected_decrease(damping, step) : 0;
    if (expected > 0) {
      const std::vector<Camera> cameras = cameras_;
      const std::vector<Eigen::Vector3d> points = points_;
      apply(step);
      const double changed = cost(), gain = (current - changed) / expected;
      moved = gain > kMinGainRatio;
      if (moved) {
        const bool settled = current - changed < kMinRelativeDecrease * current;
        damping *= std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3));
        growth = 2;
        current = changed;
        if (settled) break;
      } else {
        cameras_ = cameras;
        points_ = points;
      }
    }
    if (!moved) {
      damping *= growth;
      growth *= 2;
    }
  }
  first_observation_.pop_back();
  return true;
}

}  // namespace stillpoint::orb_slam
