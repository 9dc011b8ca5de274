// The mask of a detection: the foreground surface inside its box.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "stillpoint/options.hpp"

namespace stillpoint::segmenter_opencv_dnn {

struct BoxMaskOptions {
  double overlap = 0.4;       ///< intersection over union above which the lesser box is dropped
  double depth_step = 0.05;   ///< metres between neighbours of one surface, besides noise
  double depth_extent = 0.5;  ///< metres of an object in front of and behind its median depth
  double near_share = 0.25;   ///< of the box's centre that its nearest surface covers at least

  void visit(OptionVisitor& visitor);
};

/// CV_8UC1 of the box's size, 255 = the object: the nearest surface that covers `near_share` of the
/// middle of the box (half its width and height), grown over neighbours of similar depth inside the
/// box; small gaps in the depth image are closed. Where the middle has next to no depth, or there
/// is no depth image: the ellipse in the box. `box` lies inside the image; `depth` may be empty.
/// `noise` is its standard deviation at 1 m in metres, Camera::surface_noise.
cv::Mat box_mask(const cv::Mat& depth, double noise, const cv::Rect& box,
                 const BoxMaskOptions& options);

}  // namespace stillpoint::segmenter_opencv_dnn
