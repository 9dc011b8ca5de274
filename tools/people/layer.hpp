// What one pasted thing looks like to the camera.
#pragma once

#include <opencv2/core.hpp>

namespace stillpoint::people {

/// Images of the size of the recording's; without occlusion by anything else.
struct Layer {
  cv::Mat bgr;    ///< CV_32FC3
  cv::Mat alpha;  ///< CV_32FC1
  cv::Mat z;      ///< CV_32FC1, metres, where alpha > 0
  cv::Rect box;   ///< outside of it alpha is 0
};

}  // namespace stillpoint::people
