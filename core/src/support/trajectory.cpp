#include "stillpoint/support/trajectory.hpp"

namespace stillpoint {

std::optional<Pose> world_from_camera(const SparseMap& map, const TrackedPose& pose) {
  if (pose.state != TrackState::kTracking || pose.reference >= map.keyframe_id_end()) return {};
  return map.world_from_keyframe(pose.reference) * pose.reference_from_camera;
}

}  // namespace stillpoint
