// Depth images of a depth camera, moved into the colour camera beside it.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::depth_registration {

class DepthRegistration {
 public:
  DepthRegistration(const Camera& depth, const Camera& color, const Pose& color_from_depth)
      : depth_(depth), color_(color), color_from_depth_(color_from_depth) {}

  /// CV_16UC1 or CV_32FC1 of the depth camera's size, `factor` being one metre, as one of the
  /// colour camera's size; 0 is no measurement. Each pixel covers in the colour image what it
  /// covers in its own, so that a larger image has no holes; of surfaces behind each other the
  /// nearer one stays.
  cv::Mat register_image(const cv::Mat& depth, double factor) const;

 private:
  template <class Value>
  cv::Mat registered(const cv::Mat& depth, double factor) const;
  /// Where the corner of a pixel at depth `z` (metres) lies in the colour image: px, px, metres.
  Eigen::Vector3d in_color(double u, double v, double z) const;

  Camera depth_;
  Camera color_;
  Pose color_from_depth_;
};

}  // namespace stillpoint::depth_registration
