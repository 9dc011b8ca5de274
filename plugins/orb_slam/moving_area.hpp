// The part of the image that dynamic objects exclude from mapping.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillpoint/contracts/static_weights.hpp"

namespace stillpoint::orb_slam {

class MovingArea {
 public:
  /// Of a frame at `time`, in seconds.
  void update(const StaticWeights& weights, double time);

  /// Non-zero where no feature nearby may have a landmark, so that features of the next frame are
  /// better taken elsewhere: CV_8UC1 of the image's size, or empty where all could.
  const cv::Mat& mask() const { return mask_; }

  /// Factor on the number of features of the next frame, at most `most`: the rest of the image
  /// constrains the pose less, since it is smaller and covers a narrower field of view.
  double feature_factor(double most) const;

  /// Whether dynamic objects were in the image at `time` or in the seconds before: those that have
  /// left it may return.
  bool recent(double time) const;

 private:
  cv::Mat mask_;
  double share_ = 0.0;         // of the image
  double last_time_ = -1e300;  // of a frame in which it was more than noise, seconds
};

}  // namespace stillpoint::orb_slam
