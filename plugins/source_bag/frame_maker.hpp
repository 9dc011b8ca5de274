// Frames of images as a bag holds them.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "depth_registration/depth_registration.hpp"
#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/support/rectifier.hpp"

namespace stillpoint::source_bag {

/// Undistorts, crops, and registers depth to the colour images where it is not.
class FrameMaker {
 public:
  /// Depth is seen from the colour camera. Throws Error(kUsage) when a camera is none.
  explicit FrameMaker(const CameraModel& color);
  /// Depth is that of a camera beside it, or of the same one without its distortion.
  FrameMaker(const CameraModel& color, const CameraModel& depth, const Pose& color_from_depth);

  bool registers() const { return registration_.has_value(); }

  /// Without its index; `time` in seconds. Colour is CV_8UC3, depth CV_16UC1 as recorded or
  /// CV_32FC1 in metres. Throws Error(kData) when an image has not the size of its camera.
  Frame frame(double time, const cv::Mat& color, const cv::Mat& depth) const;

 private:
  struct Registration {
    CameraModel camera;
    Rectifier rectifier;
    depth_registration::DepthRegistration into_color;
    cv::Mat none;  // depth of the colour camera's size without a measurement
  };

  /// CV_32FC1 in metres.
  cv::Mat registered(const cv::Mat& depth) const;

  Rectifier color_;
  std::optional<Registration> registration_;
};

}  // namespace stillpoint::source_bag
