#include "orb_slam/pose_uncertainty.hpp"

#include <Eigen/Cholesky>

namespace stillpoint::orb_slam {
namespace {

constexpr double kMaxSigmaMetres = 0.010;   // standard deviation
constexpr double kMaxSigmaRadians = 0.010;  // the same

}  // namespace

Matrix6d inverse(const Matrix6d& positive_definite) {
  return positive_definite.ldlt().solve(Matrix6d::Identity());
}

PoseUncertainty uncertainty_of(const Matrix6d& information) {
  return {.covariance = inverse(information + Matrix6d::Identity())};
}

bool is_well_constrained(const Matrix6d& information) {
  const PoseUncertainty uncertainty = uncertainty_of(information);
  return uncertainty.metres() < kMaxSigmaMetres && uncertainty.radians() < kMaxSigmaRadians;
}

}  // namespace stillpoint::orb_slam
