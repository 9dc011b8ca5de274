// New landmarks of a key frame.
#pragma once

#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb {

/// Landmarks from measured depth, for features that have none: all nearer than `close_depth`
/// metres, and farther ones until the key frame sees `min_landmarks`.
std::vector<LandmarkId> create_from_depth(MapEdit& edit, KeyFrameId id, double close_depth,
                                          int min_landmarks);

/// Landmarks from two views, for features without landmark whose depth is missing or too far to be
/// good, matched along epipolar lines with the `neighbours` most covisible key frames.
std::vector<LandmarkId> triangulate(MapEdit& edit, KeyFrameId id, int neighbours);

}  // namespace stillpoint::orb
