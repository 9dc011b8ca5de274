// From poses relative to key frames to a trajectory in the world.
#pragma once

#include <optional>

#include "stillpoint/contracts/output.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// The camera's pose from the current pose of its reference key frame; the pose at the time of
/// tracking when that key frame is not in the map (not yet, or never, after a stop). Nothing when
/// the frame was not tracked, or only in a map that was cleared.
STILLPOINT_EXPORT std::optional<Pose> world_from_camera(const SparseMap& map,
                                                        const TrackedPose& pose);

}  // namespace stillpoint
