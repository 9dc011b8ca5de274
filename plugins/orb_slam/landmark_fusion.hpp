// Fuses duplicate landmarks.
#pragma once

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Projects the key frame's landmarks into its `neighbours` most covisible key frames and theirs
/// into it. A matching feature without a landmark becomes an observation; with another landmark,
/// both are fused.
void fuse_with_neighbours(MapEdit& edit, KeyFrameId id, int neighbours);

}  // namespace stillpoint::orb_slam
