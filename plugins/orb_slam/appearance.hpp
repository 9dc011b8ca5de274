// Finds the camera without any guess of where it is.
#pragma once

#include <span>
#include <vector>

#include "orb_slam/observed_frame.hpp"

namespace stillpoint::orb {

/// Features of a key frame that show a landmark, to be searched for in another image.
std::vector<Query> landmark_queries(const KeyFrame& keyframe, const SparseMap& map);

/// The same for a tracked frame.
std::vector<Query> landmark_queries(const ObservedFrame& frame, const SparseMap& map);

/// Matches landmarks by their descriptors alone, finds the pose by perspective-n-point with RANSAC,
/// then searches the same landmarks again around the places that this pose predicts. On success the
/// frame has its pose and the matched landmarks, outliers dropped. Returns the inliers, 0 when no
/// pose was found.
int locate_by_appearance(ObservedFrame& frame, std::span<const Query> landmarks,
                         const SparseMap& map);

}  // namespace stillpoint::orb
