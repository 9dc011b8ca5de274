// Where the base is, as messages.
#pragma once

#include <optional>
#include <vector>

#include "mcap_writer/messages.hpp"
#include "run_messages/mounting.hpp"
#include "stillpoint/contracts/output.hpp"

namespace stillpoint::run_messages {

struct PoseMessages {
  mcap_writer::Transform transform;
  mcap_writer::Odometry odometry;
  mcap_writer::PoseMessage pose;
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
mcap_writer::Path path_of(const SparseMap& map, const std::vector<TrackedPose>& poses,
                          const Mounting& mounting, double time);

}  // namespace stillpoint::run_messages
