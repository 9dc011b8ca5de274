// Finds a lost camera again among earlier key frames.
#pragma once

#include <optional>
#include <vector>

#include "orb_slam/observed_frame.hpp"

namespace stillpoint::orb {

/// Tries a few key frames per call, the last known place first and then round the map, so that a
/// lost frame costs a bounded time however large the map is.
class Relocaliser {
 public:
  /// Starts anew at the key frame where tracking was lost.
  void begin(KeyFrameId lost_at) { last_place_ = lost_at; }

  /// On success the frame has its pose, reference and matched landmarks. Needs a map with key
  /// frames.
  bool find(ObservedFrame& frame, const SparseMap& map);

 private:
  std::vector<KeyFrameId> candidates(const SparseMap& map);

  KeyFrameId last_place_ = kNoId;
  KeyFrameId next_ = 0;  // where the way round the map goes on
};

}  // namespace stillpoint::orb
