// The motion model: constant velocity (ORB-SLAM).
#pragma once

#include <optional>

#include "orb_slam/pose_solver.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

class ConstantVelocity {
 public:
  bool has_value() const { return current_from_last_.has_value(); }
  void reset() { current_from_last_.reset(); }

  /// The pose `seconds` after a frame at `world_from_last`.
  Pose predict(const Pose& world_from_last, double seconds) const;

  /// From two tracked frames, `seconds` apart; forgets it where that is 0. `smooth`: averaged with
  /// the previous velocity, for poses that landmarks constrain poorly: the velocity of two frames
  /// is then too noisy to predict from.
  void update(const Pose& current_from_last, double seconds, bool smooth);

 private:
  std::optional<Pose> current_from_last_;
  double seconds_ = 0.0;  // over which it was measured
};

/// Gaussian prior on a pose `seconds` after the last one, around the prediction and with the
/// standard deviation of hand-held motion.
QuadraticCost motion_prior(const Pose& predicted_world_from_camera, double seconds);

}  // namespace stillpoint::orb_slam
