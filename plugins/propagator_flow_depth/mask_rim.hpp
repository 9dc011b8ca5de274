// Outlines of networks are inaccurate by a few pixels: masks of one object differ by thin rims.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillpoint::propagator_flow_depth {

/// Morphological opening of `mask` (CV_8UC1, 0 or 255): parts up to 2 `rim` px wide are removed.
cv::Mat remove_rims(const cv::Mat& mask, int rim);

}  // namespace stillpoint::propagator_flow_depth
