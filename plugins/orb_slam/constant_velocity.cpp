#include "orb_slam/constant_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stillpoint::orb_slam {
namespace {

constexpr double kNewVelocityWeight = 0.3;  // weight of the newest velocity when it is smoothed
// Standard deviations of the change of velocity of a camera in a hand or on a small robot, per
// second: a weak prior, for directions that nothing that is measured constrains.
constexpr double kMotionMetres = 0.5;
constexpr double kMotionRadians = 0.5;

}  // namespace

Pose ConstantVelocity::predict(const Pose& world_from_last, double seconds) const {
  const Pose motion = exp_se3(log_se3(*current_from_last_) * (seconds / seconds_));
  return world_from_last * motion.inverse();
}

void ConstantVelocity::update(const Pose& current_from_last, double seconds, bool smooth) {
  if (seconds <= 0) return reset();  // two images of one time have no velocity
  const auto before = std::exchange(current_from_last_, current_from_last);
  if (smooth && before)
    current_from_last_ =
        exp_se3(kNewVelocityWeight * log_se3(current_from_last) +
                (1 - kNewVelocityWeight) * (seconds / seconds_) * log_se3(*before));
  seconds_ = seconds;
}

QuadraticCost motion_prior(const Pose& predicted_world_from_camera, double seconds) {
  QuadraticCost prior;
  seconds = std::max(seconds, 1e-3);
  prior.linearised_at = predicted_world_from_camera.inverse();
  prior.hessian.diagonal().head<3>().setConstant(1 / std::pow(kMotionMetres * seconds, 2));
  prior.hessian.diagonal().tail<3>().setConstant(1 / std::pow(kMotionRadians * seconds, 2));
  return prior;
}

}  // namespace stillpoint::orb_slam
