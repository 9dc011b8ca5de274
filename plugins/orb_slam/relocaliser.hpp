// Relocalisation of a lost camera at earlier key frames.
#pragma once

#include <functional>
#include <vector>

#include "orb_slam/observed_frame.hpp"
#include "orb_slam/place_index.hpp"

namespace stillpoint::orb_slam {

/// Tries a few key frames per call: around the place where tracking was lost, and those that look
/// like the frame. A lost frame costs a bounded time however large the map is.
class Relocaliser {
 public:
  /// Starts anew at the key frame where tracking was lost.
  void begin(KeyFrameId lost_at) { last_place_ = lost_at; }

  /// Whether the frame, with the pose, reference and matched landmarks of a candidate, is accepted;
  /// it may refine them.
  using Accept = std::function<bool()>;

  /// On success the frame is as `accept` has left it. Needs a map with key frames.
  bool find(ObservedFrame& frame, const SparseMap& map, const Accept& accept);

 private:
  std::vector<KeyFrameId> candidates(const ObservedFrame& frame, const SparseMap& map);

  KeyFrameId last_place_ = kNoId;
  PlaceIndex places_;
};

/// Share of the landmarks in view, occluded ones left out, or of the features where these are
/// fewer, that must be inliers to a relocalised pose: a thing that has been moved looks as it did,
/// and matches where it was, but not what is around it. More is asked out of reach of the last
/// tracked pose, where somebody may have carried the camera. `metres` from that pose, `seconds`
/// after it.
double required_support(double metres, double seconds);

}  // namespace stillpoint::orb_slam
