// Earlier depth views, to register against where landmarks are too few.
#pragma once

#include <deque>

#include "orb_slam/plane_registration.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// The depth views of recent key frames, or of frames near key frames.
class ReferenceViews {
 public:
  /// The views that overlap most with what the camera sees from a pose; at most two. Key frames
  /// that are not in the map yet are left out.
  struct Neighbours {
    KeyFrameId nearest = kNoId;  ///< the first of them
    std::vector<PlacedView> views;
  };
  Neighbours around(const DepthView& current, const Pose& world_from_camera,
                    const SparseMap& map) const;

  /// A view from beside a key frame; the oldest is forgotten when there are too many.
  void add(KeyFrameId keyframe, const Pose& keyframe_from_camera, DepthView view);

 private:
  struct View {
    KeyFrameId keyframe;
    Pose keyframe_from_camera;
    DepthView view;
  };
  std::deque<View> views_;
};

}  // namespace stillpoint::orb_slam
