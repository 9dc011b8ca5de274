#include "orb_slam/tracked_features.hpp"

#include <cstdint>

namespace stillpoint::orb_slam {

std::vector<TrackedFeature> tracked_features(const ObservedFrame& frame) {
  std::vector<TrackedFeature> tracked(frame.features->size());
  for (std::uint32_t i = 0; i < tracked.size(); ++i) {
    tracked[i].pixel = frame.features->keypoints[i].pt;
    if (!frame.usable(i))
      tracked[i].use = TrackedFeature::Use::kMoving;
    else if (frame.landmarks[i] != kNoId)
      tracked[i].use =
          frame.outlier[i] ? TrackedFeature::Use::kOutlier : TrackedFeature::Use::kInlier;
  }
  return tracked;
}

}  // namespace stillpoint::orb_slam
