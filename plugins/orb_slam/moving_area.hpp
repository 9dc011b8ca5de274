// The part of the image that moving things take away from the map.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillpoint/contracts/static_weights.hpp"

namespace stillpoint::orb_slam {

class MovingArea {
 public:
  /// Of a frame at `time`, in seconds.
  void update(const StaticWeights& weights, double time);

  /// Not 0 where no feature nearby could have a landmark, so that the next frame's features are
  /// better spent elsewhere: CV_8UC1 of the image's size, or empty where all could.
  const cv::Mat& mask() const { return mask_; }

  /// How many times as many features the next frame needs, at most `most`: what is left of the
  /// image says less, since it is smaller and since it is a narrower view.
  double feature_factor(double most) const;

  /// Whether something moved in the image at `time` or in the seconds before: what has left it may
  /// be back.
  bool recent(double time) const;

 private:
  cv::Mat mask_;
  double share_ = 0.0;         // of the image
  double last_time_ = -1e300;  // of a frame in which it was more than noise, seconds
};

}  // namespace stillpoint::orb_slam
