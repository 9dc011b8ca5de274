// The depth interval of an object.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillpoint::propagator_flow_depth {

/// Metres. `far` 0: nothing is known.
struct DepthLayer {
  float near = 0.0f;
  float middle = 0.0f;  ///< median
  float far = 0.0f;

  bool known() const { return far > 0; }
  bool contains(float depth) const { return depth >= near && depth <= far; }
  DepthLayer moved_by(float metres) const {
    return known() ? DepthLayer{near + metres, middle + metres, far + metres} : *this;
  }
};

/// From the measurements under a mask (CV_8UC1, both of one size): the interval of depth around the
/// median without gaps. Background that a mask wrongly covers lies behind such a gap.
DepthLayer depth_layer(const cv::Mat& depth, const cv::Mat& mask);

}  // namespace stillpoint::propagator_flow_depth
