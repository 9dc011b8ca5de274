// One RGB-D image pair, as every stage sees it.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "stillpoint/contracts/camera.hpp"

namespace stillpoint {

/// Made by the source and never changed afterwards: its images are shared between threads. A copy
/// shares the pixels and may be kept (2.5 MB of 640 × 480 px); to change an image, clone() it.
struct Frame {
  std::uint32_t index = 0;  ///< 0, 1, 2 … in the order in which the source gave them
  double time = 0.0;        ///< seconds, of the colour image
  cv::Mat bgr;              ///< CV_8UC3, undistorted
  cv::Mat gray;             ///< CV_8UC1, of bgr
  cv::Mat depth;            ///< CV_32FC1, metres along z, 0 = no measurement; registered to bgr
  std::shared_ptr<const Camera> camera;  ///< never null in a run
};
using FramePtr = std::shared_ptr<const Frame>;

}  // namespace stillpoint
