// Maps for stages that get one, made without a local mapper.
#pragma once

#include <stop_token>

#include "plugin_check/observer.hpp"
#include "plugin_check/scenario.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::plugin_check {

inline constexpr std::size_t kFramesPerKeyFrame = 3;

/// As a pipeline without a local mapper does it.
SparseMap inserted(SparseMap map, KeyFrame keyframe);

/// `map`, which has a key frame, after `count` others and as many landmarks were made and removed
/// again. Takes a second for 66,000.
SparseMap with_large_ids(SparseMap map, KeyFrameId count);

/// What the run of a scenario begins with: no map, or a saved one, whose next key frame is
/// Scenario::first_keyframe.
SparseMap saved_map(const Scenario& scenario);

/// The poses and landmarks of a result.
void saw(Observer& observer, const SparseMap& map);

std::stop_token requested_stop();

}  // namespace stillpoint::plugin_check
