// Where the base is, as messages.
#pragma once

#include <optional>
#include <vector>

#include "ros2_messages/messages.hpp"
#include "ros2_messages/mounting.hpp"
#include "stillpoint/contracts/output.hpp"

namespace stillpoint::ros2_messages {

struct PoseMessages {
  Transform transform;
  Odometry odometry;
  PoseMessage pose;
};

/// Messages of one frame after the other. The velocity is that from the frame before, where that
/// was tracked, in the frame of the base.
class PoseSequence {
 public:
  explicit PoseSequence(Mounting mounting) : mounting_(std::move(mounting)) {}

  /// `time` in seconds. Nothing for a frame that was not tracked.
  std::optional<PoseMessages> next(double time, const TrackResult& result);

 private:
  Mounting mounting_;
  std::optional<StampedPose> previous_;  // map_from_base
};

/// Of the tracked frames, as the map's key frames are now.
Path path_of(const SparseMap& map, const std::vector<TrackedPose>& poses, const Mounting& mounting,
             double time);

}  // namespace stillpoint::ros2_messages
