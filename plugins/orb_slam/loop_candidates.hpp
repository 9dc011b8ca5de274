// Places that several key frames in a row look like (ORB-SLAM, section VII-A).
#pragma once

#include <vector>

#include "orb_slam/place_index.hpp"

namespace stillpoint::orb_slam {

/// One look at one place may be chance. A candidate counts when the key frames before also had one
/// in the same part of the map: among its covisible key frames.
class LoopCandidates {
 public:
  /// Candidates for the newest key frame, best first. Call it for every key frame, in order.
  std::vector<KeyFrameId> find(const SparseMap& map, KeyFrameId newest);

 private:
  struct Group {
    std::vector<KeyFrameId> keyframes;  // a candidate and those covisible with it, sorted
    int seen = 1;                       // by so many key frames in a row
  };

  Group follow(const SparseMap& map, KeyFrameId candidate) const;

  PlaceIndex index_;
  std::vector<Group> groups_;  // of the key frame before
};

}  // namespace stillpoint::orb_slam
