// The part of the map around a frame (ORB-SLAM, "track local map").
#pragma once

#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb {

struct LocalMap {
  KeyFrameId reference = kNoId;       ///< shares most landmarks with the frame
  std::vector<KeyFrameId> keyframes;  ///< those that share landmarks, and their neighbours
  std::vector<LandmarkId> landmarks;  ///< seen by them, each once
};

/// Around the landmarks that a frame has matched; empty when there are none.
LocalMap local_map_around(const std::vector<LandmarkId>& matched, const SparseMap& map,
                          int max_keyframes);

}  // namespace stillpoint::orb
