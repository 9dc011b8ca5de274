// Evidence of a frame on whether the landmarks in view are still static: inlier matches for it,
// free-space violations against it.
#pragma once

#include <span>
#include <unordered_map>

#include "orb_slam/observed_frame.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Landmarks with lower log-odds of being static are taken for dynamic and removed.
constexpr float kMovedLogOdds = -3.0F;

/// The log-odds are clamped to ± this: what has been static for long may begin to move.
constexpr float kMaxStaticLogOdds = 6.0F;

using EvidenceByLandmark = std::unordered_map<LandmarkId, LandmarkEvidence>;

/// For the landmarks that should be visible in a frame whose pose is known. An inlier counts for
/// static, by the weight of its feature; one that lies in front of the measured depth, in free
/// space, counts against it. Occluded landmarks do not count as visible: a crowd that passes by
/// must not have them removed. `seconds` since the frame before: at another rate than 30 Hz a frame
/// counts for more or less. `evidence` is what has been added since the last key frame; with what
/// the map has, it stays within kMaxStaticLogOdds.
void add_static_evidence(const ObservedFrame& frame, const SparseMap& map,
                         std::span<const LandmarkId> visible, double seconds,
                         EvidenceByLandmark& evidence);

/// How many of these landmarks the frame should see: those that nothing nearer occludes.
int count_unoccluded(const ObservedFrame& frame, const SparseMap& map,
                     std::span<const LandmarkId> visible);

}  // namespace stillpoint::orb_slam
