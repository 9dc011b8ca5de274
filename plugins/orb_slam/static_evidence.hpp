// What a frame tells about each landmark in view: that it still stands where it was, or that it
// does not.
#pragma once

#include <span>
#include <unordered_map>

#include "orb_slam/observed_frame.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Landmarks with less than this are taken for things that moved, and removed.
constexpr float kMovedLogOdds = -3.0F;

using EvidenceByLandmark = std::unordered_map<LandmarkId, LandmarkEvidence>;

/// For the landmarks that should be visible in a frame whose pose is known. One that fits the pose
/// counts for static, by the weight of its feature; one that lies in front of the measured depth,
/// in free space, counts against it. What is occluded tells nothing.
void add_static_evidence(const ObservedFrame& frame, const SparseMap& map,
                         std::span<const LandmarkId> visible, EvidenceByLandmark& evidence);

}  // namespace stillpoint::orb_slam
