// Joins landmarks that are the same point.
#pragma once

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Looks for the key frame's landmarks in its `neighbours` most covisible key frames and for theirs
/// in it: found without a landmark, it becomes an observation; found with another one, both are
/// fused.
void fuse_with_neighbours(MapEdit& edit, KeyFrameId id, int neighbours);

}  // namespace stillpoint::orb_slam
