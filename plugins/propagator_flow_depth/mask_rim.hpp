// Outlines of networks are a few pixels off: what sets two masks of one thing apart are rims.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillpoint::propagator_flow_depth {

/// `mask` (CV_8UC1, 0 or 255) without what is no wider than twice `rim` pixels.
cv::Mat without_rims(const cv::Mat& mask, int rim);

}  // namespace stillpoint::propagator_flow_depth
