// Scores that follow the edges of the image (He, Sun, Tang: Guided Image Filtering, TPAMI 2013).
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillpoint/options.hpp"

namespace stillpoint::segmenter_opencv_dnn {

struct RefinementOptions {
  int radius = 0;         ///< cells; 0: leave the scores as they are
  double epsilon = 0.01;  ///< variance of gray, black to white being 1, that counts as flat

  void visit(OptionVisitor& visitor);
};

/// In every window the result is a linear function of the guide: it keeps the guide's edges and
/// averages where the guide is flat.
class GuidedFilter {
 public:
  /// `gray`: CV_8UC1, of the same area as the scores; it is brought to `cells`.
  GuidedFilter(const cv::Mat& gray, cv::Size cells, const RefinementOptions& options);

  /// `scores`: CV_32FC1 of the size `cells`.
  cv::Mat operator()(const cv::Mat& scores) const;

 private:
  cv::Mat mean(const cv::Mat& image) const;

  cv::Size window_;
  cv::Mat guide_;
  cv::Mat guide_mean_;
  cv::Mat flatness_;  // variance of the guide in the window, plus epsilon
};

}  // namespace stillpoint::segmenter_opencv_dnn
