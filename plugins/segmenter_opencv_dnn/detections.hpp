// Boxes that a detection network puts out.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace stillpoint::segmenter_opencv_dnn {

struct Detection {
  int label = 0;       ///< class id, 0 is the background
  float score = 0.0f;  ///< in [0, 1]
  cv::Rect2f box;      ///< shares of the image's width and height
};

/// Whether an output is a list of boxes: Darknet's regions, one row per box (centre x, y, width,
/// height, objectness, one score per class without a background), or SSD's 1 x 1 x N x 7 (image,
/// class id, score, left, top, right, bottom). The number of classes counts the background.
bool holds_boxes(const cv::Mat& output, std::size_t classes);

/// The boxes with at least `threshold`, best first. Of two of a class that overlap by more than
/// `overlap` (intersection over union) the better one is kept. Throws Error(kData) for a class id
/// beyond the number of classes.
std::vector<Detection> detections(const std::vector<cv::Mat>& outputs, std::size_t classes,
                                  double threshold, double overlap);

}  // namespace stillpoint::segmenter_opencv_dnn
