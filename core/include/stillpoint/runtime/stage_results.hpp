// What stages give, checked where it enters the runtime: a plugin's mistake ends the run with the
// plugin's name, and never becomes a wrong result or a read out of bounds. All checks of a frame
// together take 0.1 ms; thorough_checks.hpp has those that take longer. They throw Error(kStage),
// to be named by the caller (in_stage).
#pragma once

#include <opencv2/core/types.hpp>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/map_correction.hpp"
#include "stillpoint/contracts/map_evidence.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/contracts/static_weights.hpp"
#include "stillpoint/contracts/tracker.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Of a source: `index` is the one that comes next, `previous` the frame before, or null.
STILLPOINT_EXPORT void check_frame(const Frame& frame, std::uint32_t index, const Frame* previous);

/// Of a segmenter or a propagator, for a frame; `classes`: how many labels there are, the
/// background included. Labels that are not known are right.
STILLPOINT_EXPORT void check_segmentation(const Segmentation& segmentation, const Frame& of,
                                          std::size_t classes);

/// Of a moving check, for frames of this size.
STILLPOINT_EXPORT void check_moving_points(const MovingPoints& moving, cv::Size frame);

/// Of a map check, for a frame of this size.
STILLPOINT_EXPORT void check_evidence(const MapEvidence& evidence, cv::Size frame);

/// Of a decision on these labels.
STILLPOINT_EXPORT void check_weights(const StaticWeights& weights, const Segmentation& segmentation,
                                     cv::Size frame);

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

}  // namespace stillpoint
