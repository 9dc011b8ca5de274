// From poses relative to key frames to a trajectory in the world.
#pragma once

#include <optional>

#include "stillpoint/contracts/output.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Where the camera was, by what the map says now of the pose's reference key frame. Nothing while
/// it was not tracked, or when the map does not know the key frame yet.
STILLPOINT_EXPORT std::optional<Pose> world_from_camera(const SparseMap& map,
                                                        const TrackedPose& pose);

}  // namespace stillpoint
