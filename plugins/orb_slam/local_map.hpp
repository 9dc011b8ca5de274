// The part of the map around a frame (ORB-SLAM, "track local map").
#pragma once

#include <vector>

#include "orb_slam/observed_frame.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

struct LocalMap {
  KeyFrameId reference = kNoId;       ///< shares most landmarks with the frame
  std::vector<KeyFrameId> keyframes;  ///< those that share landmarks, and their neighbours
  std::vector<LandmarkId> landmarks;  ///< seen by them, each once
};

/// Around the landmarks that a frame has matched; empty when there are none.
LocalMap local_map_around(const std::vector<LandmarkId>& matched, const SparseMap& map,
                          int max_keyframes);

/// Matches the local map's landmarks to the frame's free features within `window` px of their
/// places at its present pose. Adds those that should be in view, matched or not, to `visible`.
void search(ObservedFrame& frame, const LocalMap& local, const SparseMap& map, double window,
            std::vector<LandmarkId>& visible);

}  // namespace stillpoint::orb_slam
