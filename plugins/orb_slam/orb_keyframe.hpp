// This plugin needs key frames with ORB features; those of other trackers are refused.
#pragma once

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Throws Error(kStage) when a key frame's features have no 256-bit descriptors, or a pyramid that
/// ScalePyramid does not take.
void require_orb(const KeyFrame& keyframe);
void require_orb(const SparseMap& map);

}  // namespace stillpoint::orb_slam
