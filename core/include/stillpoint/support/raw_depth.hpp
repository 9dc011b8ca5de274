// Depth in whole numbers, as sensors and recordings have it.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillpoint {

/// CV_16UC1 with `factor` for a metre, of CV_32FC1 in metres. 0 is no measurement, and so is what
/// is too far for 16 bits, infinite or NaN.
inline cv::Mat raw_depth(const cv::Mat& metres, double factor) {
  constexpr double kLargest = 65535;
  cv::Mat raw;
  metres.convertTo(raw, CV_16U, factor);
  raw.setTo(0, metres * factor > kLargest);
  return raw;
}

}  // namespace stillpoint
