// Verifies that two key frames show one place (DS-SLAM III-A; ORB-SLAM, section VII).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// A place that the map holds twice.
struct LoopMatch {
  KeyFrameId keyframe = kNoId;  ///< the newer one
  KeyFrameId place = kNoId;     ///< the older one
  Pose world_from_camera =
      Pose::Identity();  ///< of `keyframe`, as the older part of the map has it
  int inliers = 0;       ///< older landmarks that fit it
  double support = 0;    ///< their share of those that should be seen, 0 … 1
  std::vector<std::pair<LandmarkId, LandmarkId>> same;  ///< older, newer
};

/// 3-D/3-D RANSAC between the key frame's measured points and the landmarks around `place`, then a
/// guided search for all of these. Nothing unless enough landmarks fit and most of those that
/// should be seen are there: one poster in two rooms fits, but nothing around it does. Features
/// that must not be mapped take no part.
std::optional<LoopMatch> match_loop(const SparseMap& map, KeyFrameId keyframe, KeyFrameId place);

}  // namespace stillpoint::orb_slam
