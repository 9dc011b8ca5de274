// Snaps the outline of a mask to depth discontinuities.
#pragma once

#include <opencv2/core/mat.hpp>

#include "propagator_flow_depth/depth_layer.hpp"

namespace stillpoint::propagator_flow_depth {

struct MaskFitOptions {
  int margin = 4;          ///< px that the outline may move outwards
  double tolerance = 0.1;  ///< metres between depths that count as different, at 2 m
};

/// Which pixels of `predicted` (CV_8UC1, 0 or 255) and around it belong to the object. Each decides
/// by whether its depth is that of the object nearby or that of what surrounds it. Where these are
/// the same (feet on the floor, a hand on the desk) or nothing was measured, the prediction holds.
cv::Mat fit_to_depth(const cv::Mat& predicted, const cv::Mat& depth, const DepthLayer& layer,
                     const MaskFitOptions& options);

}  // namespace stillpoint::propagator_flow_depth
