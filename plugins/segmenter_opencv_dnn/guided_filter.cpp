#include "segmenter_opencv_dnn/guided_filter.hpp"

#include <opencv2/imgproc.hpp>

namespace stillpoint::segmenter_opencv_dnn {

void RefinementOptions::visit(OptionVisitor& v) {
  v("radius", radius,
    {.min = 0, .max = 100, .unit = "cells", .help = "radius of the guided filter; 0: none"});
  v("epsilon", epsilon,
    {.min = 1e-6,
     .max = 1,
     .help = "variance of grey levels (black 0, white 1) below which the image counts as flat; "
             "larger: smoother masks, which follow edges less"});
}

GuidedFilter::GuidedFilter(const cv::Mat& gray, cv::Size cells, const RefinementOptions& options)
    : window_(2 * options.radius + 1, 2 * options.radius + 1) {
  cv::Mat small;
  cv::resize(gray, small, cells);
  small.convertTo(guide_, CV_32F, 1.0 / 255);
  guide_mean_ = mean(guide_);
  flatness_ = mean(guide_.mul(guide_)) - guide_mean_.mul(guide_mean_) + options.epsilon;
}

cv::Mat GuidedFilter::operator()(const cv::Mat& scores) const {
  const cv::Mat score_mean = mean(scores);
  // Equations 5, 6 and 8 of the paper: scores = slope * guide + offset in each window.
  const cv::Mat slope = (mean(guide_.mul(scores)) - guide_mean_.mul(score_mean)) / flatness_;
  const cv::Mat offset = score_mean - slope.mul(guide_mean_);
  return mean(slope).mul(guide_) + mean(offset);
}

cv::Mat GuidedFilter::mean(const cv::Mat& image) const {
  cv::Mat result;
  cv::blur(image, result, window_);
  return result;
}

}  // namespace stillpoint::segmenter_opencv_dnn
