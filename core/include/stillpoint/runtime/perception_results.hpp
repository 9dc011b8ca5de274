// What source, segmentation, moving check, map check and decision give, checked where it enters the
// runtime: a plugin's mistake ends the run with the plugin's name, and never becomes a wrong result
// or a read out of bounds. mapping_results.hpp has the checks of tracker and mapping; all of a
// frame together take 0.1 ms. Those that take longer are in thorough_checks.hpp. They throw
// Error(kStage), to be named by the caller (in_stage).
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/types.hpp>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/map_evidence.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/contracts/static_weights.hpp"
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

}  // namespace stillpoint
