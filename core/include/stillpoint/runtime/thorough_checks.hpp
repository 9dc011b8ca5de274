// `runtime.validate: full`: what a stage gives is looked at value by value. For authors of plugins:
// some milliseconds per frame. They throw Error(kStage), to be named by the caller (in_stage).
#pragma once

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/map_correction.hpp"
#include "stillpoint/contracts/map_evidence.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/contracts/tracker.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Of a source: depths.
STILLPOINT_EXPORT void check_thoroughly(const Frame& frame);

/// Of a moving check.
STILLPOINT_EXPORT void check_thoroughly(const MovingPoints& moving);

/// Of a map check.
STILLPOINT_EXPORT void check_thoroughly(const MapEvidence& evidence);

/// Of a tracker: the uncertainty of the pose.
STILLPOINT_EXPORT void check_thoroughly(const TrackResult& result);

/// Of a local mapper, or after a correction: links, poses and positions.
STILLPOINT_EXPORT void check_thoroughly(const SparseMap& map);

}  // namespace stillpoint
