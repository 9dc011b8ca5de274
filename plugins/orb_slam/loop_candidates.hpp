// Loop candidates that are consistent over consecutive key frames (ORB-SLAM, section VII-A).
#pragma once

#include <vector>

#include "orb_slam/place_index.hpp"

namespace stillpoint::orb_slam {

/// A single match may be a false positive. A candidate counts when the previous key frames had one
/// in the same part of the map as well, that is, among its covisible key frames.
class LoopCandidates {
 public:
  /// Candidates for the newest key frame, best first. Call it for every key frame, in order.
  std::vector<KeyFrameId> find(const SparseMap& map, KeyFrameId newest);

 private:
  struct Group {
    std::vector<KeyFrameId> keyframes;  // a candidate and those covisible with it, sorted
    int seen = 1;                       // consecutive key frames with a consistent candidate
  };

  Group consistent_group(const SparseMap& map, KeyFrameId candidate) const;

  PlaceIndex index_;
  std::vector<Group> groups_;  // of the key frame before
};

}  // namespace stillpoint::orb_slam
