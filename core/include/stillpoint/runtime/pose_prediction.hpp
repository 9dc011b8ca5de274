// Where the camera may be in the next frame, before it has been tracked.
#pragma once

#include <optional>
#include <vector>

#include "stillpoint/contracts/map_checker.hpp"
#include "stillpoint/contracts/moving_points.hpp"

namespace stillpoint {

/// Remembers the last tracked frame and the velocity.
class PosePrediction {
 public:
  /// After each frame; nothing when it has no pose.
  void tracked(const std::optional<TrackedFrame>& frame, const SparseMap& map);

  /// Possible world_from_camera at `time` (seconds): from the camera motion of the moving check,
  /// from constant velocity, and without motion. Empty when the last frame has no pose.
  std::vector<Pose> guesses(double time, const MovingPoints& moving, const SparseMap& map) const;

 private:
  std::optional<TrackedFrame> last_;
  Vector6d velocity_ = Vector6d::Zero();  // twist of current_from_previous per second
};

}  // namespace stillpoint
