// Depth views of the newest key frames, to hold on to where landmarks are too few.
#pragma once

#include <deque>

#include "orb_slam/plane_registration.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

class DepthAnchor {
 public:
  /// Views that show most of what a camera sees from a place; at most two. Key frames that are not
  /// in the map yet are left out.
  struct Neighbours {
    KeyFrameId nearest = kNoId;  ///< the first of them
    std::vector<PlacedView> views;
  };
  Neighbours around(const DepthView& current, const Pose& world_from_camera,
                    const SparseMap& map) const;

  /// The view of a new key frame; the oldest is forgotten when there are too many.
  void add(KeyFrameId keyframe, DepthView view);

 private:
  struct View {
    KeyFrameId keyframe;
    DepthView view;
  };
  std::deque<View> views_;
};

}  // namespace stillpoint::orb_slam
