// From the network's scores to labels.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillpoint/contracts/segmentation.hpp"

namespace stillpoint::segmenter_segnet {

/// Both of the size of the scores.
struct PickedClasses {
  cv::Mat labels;       ///< CV_8UC1: class with the highest score; the first one of equals
  cv::Mat probability;  ///< CV_32FC1: of that class by softmax; 1 for class 0, which is not used
};

/// `scores`: 1 x classes x height x width, CV_32F, at most 256 classes.
PickedClasses pick_classes(const cv::Mat& scores);

/// Gives each object the mean of `probability` (of the frame's size) over its pixels as its score.
void score_objects(Segmentation& segmentation, const cv::Mat& probability);

}  // namespace stillpoint::segmenter_segnet
