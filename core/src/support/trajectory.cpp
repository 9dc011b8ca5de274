#include "stillpoint/support/trajectory.hpp"

namespace stillpoint {

std::optional<Pose> world_from_camera(const SparseMap& map, const TrackedPose& pose) {
  if (pose.state != TrackState::kTracking) return {};
  if (pose.reference < map.keyframe_id_begin()) return {};
  if (pose.reference >= map.keyframe_id_end()) return pose.world_from_camera;
  return map.world_from_keyframe(pose.reference) * pose.reference_from_camera;
}

}  // namespace stillpoint
