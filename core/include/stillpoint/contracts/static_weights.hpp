// Weights per pixel: the confidence that it shows the static world (paper III-D).
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace stillpoint {

/// Two images, because "do not track on it" and "do not map it" differ: a chair that stands still
/// helps tracking today and should not be in tomorrow's map. An empty image means 255 everywhere.
struct StaticWeights {
  cv::Mat track;                   ///< CV_8UC1: 255 static … 0 do not use
  cv::Mat map;                     ///< CV_8UC1: 255 static … 0 do not use
  std::vector<bool> object_moves;  ///< per object of the frame's Segmentation; may be empty

  /// Of the pixel that (u, v) lies in, which must be one of the image.
  static std::uint8_t at(const cv::Mat& weights, float u, float v) {
    return weights.empty() ? std::uint8_t{255} : weights.at<std::uint8_t>(cvRound(v), cvRound(u));
  }
};

}  // namespace stillpoint
