// What tracking made of each feature of a frame, for pictures and statistics.
#pragma once

#include <vector>

#include "orb_slam/observed_frame.hpp"
#include "stillpoint/contracts/tracker.hpp"

namespace stillpoint::orb_slam {

/// Per feature, in their order.
std::vector<TrackedFeature> tracked_features(const ObservedFrame& frame);

}  // namespace stillpoint::orb_slam
