#include "stillpoint/contracts/pose_uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace stillpoint {
namespace {

double largest_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(eigen.eigenvalues().z(), 0.0));
}

}  // namespace

double PoseUncertainty::metres() const { return largest_sigma(covariance.topLeftCorner<3, 3>()); }
double PoseUncertainty::radians() const {
  return largest_sigma(covariance.bottomRightCorner<3, 3>());
}

}  // namespace stillpoint
