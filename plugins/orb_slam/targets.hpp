// Points of known position that may be matched in another image, for tracking from frame to frame,
// relocalisation and loop closing.
#pragma once

#include <span>
#include <vector>

#include "orb_slam/observed_frame.hpp"

namespace stillpoint::orb_slam {

struct Target {
  LandmarkId landmark = kNoId;     ///< kNoId: a temporary point, measured by one frame's depth only
  Eigen::Vector3d point_in_world;  ///< metres
  Descriptor descriptor{};
  int octave = 0;      ///< pyramid level it was seen on
  float angle = 0.0f;  ///< degrees, of the feature it was seen as
};

/// The landmarks that a key frame sees.
std::vector<Target> targets_of(const KeyFrame& keyframe, const SparseMap& map);

/// The landmarks that a tracked frame sees and, for its other features with depth and full weight,
/// temporary points: with them tracking continues in views that are not mapped yet.
std::vector<Target> targets_of(const ObservedFrame& frame, const SparseMap& map);

/// Searches `window` px (at the target's level) around the places where a camera would see the
/// targets, `levels` up and down the pyramid, and assigns what it finds to the frame's usable
/// features. Returns the number of matches.
int match_projected(ObservedFrame& frame, std::span<const Target> targets,
                    const Pose& camera_from_world, double window, int levels);

/// Replaces the frame's matches by these, whose ids are indices of targets.
void assign_targets(ObservedFrame& frame, std::span<const Target> targets,
                    std::span<const Match> matches);

}  // namespace stillpoint::orb_slam
