// Verifies that two key frames show one place (DS-SLAM III-A; ORB-SLAM, section VII).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// A verified loop: a place that is in the map twice.
struct LoopMatch {
  KeyFrameId keyframe = kNoId;  ///< the newer one
  KeyFrameId place = kNoId;     ///< the older one
  Pose world_from_camera =
      Pose::Identity();  ///< of `keyframe`, as the older part of the map has it
  int inliers = 0;       ///< older landmarks
  double support = 0;    ///< share of inliers in the landmarks that should be in view, or in the
                         ///< features where these are fewer; 0 … 1
  std::vector<std::pair<LandmarkId, LandmarkId>> same;  ///< older, newer
};

/// 3-D/3-D RANSAC between the key frame's measured points and the landmarks around `place`, then a
/// guided search for all of these. Nothing unless there are enough inliers, and enough of them for
/// what should be in view: a poster that hangs in two rooms matches, but nothing around it does.
/// Features that must not be mapped are not used.
std::optional<LoopMatch> match_loop(const SparseMap& map, KeyFrameId keyframe, KeyFrameId place);

}  // namespace stillpoint::orb_slam
