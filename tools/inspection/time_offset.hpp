// Estimates how far the clocks of colour and depth are apart, from how the pictures move.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <span>
#include <string>
#include <vector>

namespace stillpoint::inspection {

/// How fast the picture as a whole moved between two images.
struct PictureVelocity {
  double time = 0.0;     ///< seconds, midway between the two images
  cv::Point2d velocity;  ///< image widths per second
};

/// Velocities of one stream over a stretch of consecutive images, by phase correlation.
class VelocityTrack {
 public:
  void add_color(double time, const cv::Mat& bgr);
  void add_depth(double time, const cv::Mat& raw);  ///< CV_16UC1
  const std::vector<PictureVelocity>& velocities() const { return velocities_; }

 private:
  void add(double time, const cv::Mat& small);

  cv::Mat previous_;
  double previous_time_ = 0.0;
  std::vector<PictureVelocity> velocities_;
};

/// A stretch of the recording seen by both sensors.
struct MotionStretch {
  VelocityTrack color;
  VelocityTrack depth;
};

struct TimeOffset {
  bool known = false;
  std::string reason;        ///< why it is not known
  double offset = 0.0;       ///< seconds to add to the depth stamps
  double deviation = 0.0;    ///< seconds, standard error over the stretches
  double correlation = 0.0;  ///< of the velocities of the two sensors at this offset
};

/// Searches the offset within ±150 ms at which the velocities of both sensors agree best.
TimeOffset estimate_time_offset(std::span<const MotionStretch> stretches);

}  // namespace stillpoint::inspection
