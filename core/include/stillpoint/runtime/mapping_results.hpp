// What tracker, local mapping and loop closing give, checked where it enters the runtime, as in
// perception_results.hpp.
#pragma once

#include <span>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/labelled_point.hpp"
#include "stillpoint/contracts/map_correction.hpp"
#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/contracts/tracker.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Of a tracker, before it tracks `frame`.
STILLPOINT_EXPORT void check_prepared(const PreparedFrame* prepared, const Frame& frame);

/// Of a tracker, for a frame and what it was told.
STILLPOINT_EXPORT void check_tracking(const TrackResult& result, const Frame& frame,
                                      const SparseMap& map, const TrackHints& hints);

/// Of a local mapper that has inserted a key frame, or refined around one: what is new is looked
/// at.
STILLPOINT_EXPORT void check_inserted(const SparseMap& map, const SparseMap& before);
STILLPOINT_EXPORT void check_refined(const SparseMap& map, const SparseMap& before);

/// Of a loop closer, for a map.
STILLPOINT_EXPORT void check_correction(const MapCorrection& correction, const SparseMap& map);

/// Of a dense map.
STILLPOINT_EXPORT void check_points(std::span<const LabelledPoint> points);

}  // namespace stillpoint
