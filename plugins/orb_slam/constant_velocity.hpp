// The motion model: the camera goes on as it went (ORB-SLAM).
#pragma once

#include <optional>

#include "orb_slam/pose_solver.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

class ConstantVelocity {
 public:
  bool known() const { return current_from_last_.has_value(); }
  void forget() { current_from_last_.reset(); }

  /// The pose `seconds` after a frame at `world_from_last`.
  Pose predict(const Pose& world_from_last, double seconds) const;

  /// From two tracked frames, `seconds` apart. `smooth`: mixed with the velocity before, for where
  /// the camera is about to slide and single velocities are too noisy to go on with.
  void update(const Pose& current_from_last, double seconds, bool smooth);

 private:
  std::optional<Pose> current_from_last_;
  double seconds_ = 0.0;  // over which it was measured
};

/// What the prediction says of a pose `seconds` after the last one, with the standard deviation of
/// hand-held motion; the same at every pose.
QuadraticCost motion_prior(const Pose& predicted_world_from_camera, double seconds);

}  // namespace stillpoint::orb_slam
