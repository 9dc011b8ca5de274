// Culling of unreliable landmarks and redundant key frames.
#pragma once

#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Checks the landmarks of the last few key frames (`recent`): those that are found in too few of
/// the frames that should see them, or that no second key frame has seen in time, are removed;
/// those that pass leave the list (ORB-SLAM, "recent map points culling").
void cull_landmarks(MapEdit& edit, KeyFrameId latest, std::vector<LandmarkId>& recent);

/// Removes covisible key frames nearly all of whose landmarks are seen by three others, at most one
/// pyramid level coarser (ORB-SLAM, "local key frame culling").
void cull_keyframes(MapEdit& edit, KeyFrameId latest, double redundant_share);

}  // namespace stillpoint::orb_slam
