// Pose graph optimisation: distributes the loop error over the key frames (ORB-SLAM, VII-D).
#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "stillpoint/contracts/map_correction.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Relative pose of two key frames.
struct PoseEdge {
  KeyFrameId a = kNoId, b = kNoId;
  Pose a_from_b = Pose::Identity();
};

/// Optimises the essential graph: the spanning tree, pairs of key frames that share at least 100
/// landmarks, both as the map has them now, and `loops`, where a key frame that has been removed
/// gives way to the nearest older one. The first key frame stays. Gives the best so far when `stop`
/// is requested; empty when there is no solution.
std::vector<MovedKeyFrame> optimise_pose_graph(const SparseMap& map,
                                               std::span<const PoseEdge> loops,
                                               std::stop_token stop);

}  // namespace stillpoint::orb_slam
