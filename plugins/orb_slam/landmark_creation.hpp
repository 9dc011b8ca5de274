// New landmarks of a key frame.
#pragma once

#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Landmarks from measured depth, for all features that have none yet.
std::vector<LandmarkId> create_from_depth(MapEdit& edit, KeyFrameId id);

/// Landmarks from two views for features without landmark (mostly without depth), matched along
/// epipolar lines with the `neighbours` most covisible key frames.
std::vector<LandmarkId> triangulate(MapEdit& edit, KeyFrameId id, int neighbours);

}  // namespace stillpoint::orb_slam
