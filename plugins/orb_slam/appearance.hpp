// The camera pose from descriptor matches alone, without a prediction.
#pragma once

#include <span>

#include "orb_slam/targets.hpp"

namespace stillpoint::orb_slam {

/// Matches targets by their descriptors alone, finds the pose by perspective-n-point with RANSAC,
/// then searches the same targets again around the places that this pose predicts. On success the
/// frame has its pose and the matches that fit it. Returns their number, 0 when no pose was found.
int locate_by_appearance(ObservedFrame& frame, std::span<const Target> targets,
                         const SparseMap& map);

}  // namespace stillpoint::orb_slam
