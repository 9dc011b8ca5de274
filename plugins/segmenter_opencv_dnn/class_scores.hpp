// From a network's output to class scores and probabilities.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "segmenter_opencv_dnn/cell_labels.hpp"

namespace stillpoint::segmenter_opencv_dnn {

enum class ResultKind {
  kClassLogits,         ///< one plane per class, softmax still to be done
  kClassProbabilities,  ///< one plane per class
  kProbability,         ///< one plane, of class 1
  kLogit,               ///< one plane, of class 1, sigmoid still to be done
  kBoxes                ///< detections
};

struct ScoreRule {
  ResultKind result = ResultKind::kProbability;
  double threshold = 0.5;  ///< least probability
  double margin = 0.0;     ///< least lead of a logit over that of the background
};

/// The planes of an output (1 x channels x height x width, or without the 1), none of them copied.
/// Empty when the output is of another shape.
std::vector<cv::Mat> planes_of(const cv::Mat& output);

/// The planes that compete for a pixel under a rule.
std::vector<ScorePlane> competing_planes(const std::vector<cv::Mat>& planes, const ScoreRule& rule);

/// Probability of every class, by class id. That of the background may be empty.
std::vector<cv::Mat> probabilities(const std::vector<cv::Mat>& planes, ResultKind result);

}  // namespace stillpoint::segmenter_opencv_dnn
