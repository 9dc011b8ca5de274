// From poses relative to key frames to a trajectory in the world.
#pragma once

#include <optional>

#include "stillpoint/contracts/output.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Where the camera was, by what the map says now of the pose's reference key frame, and as it was
/// tracked when that is not in the map: not yet, or never, after a stop. Nothing while it was not
/// tracked.
STILLPOINT_EXPORT std::optional<Pose> world_from_camera(const SparseMap& map,
                                                        const TrackedPose& pose);

}  // namespace stillpoint
