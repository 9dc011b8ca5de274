// What a pixel of the recording looks at.
#pragma once

#include <opencv2/core.hpp>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::people {

/// The recorded images of a camera, with its distortion.
class Rays {
 public:
  explicit Rays(const CameraModel& camera);

  cv::Size size() const { return rays_.size(); }
  /// (x, y) of the direction (x, y, 1) in the camera frame.
  const cv::Vec2f& at(int row, int column) const { return rays_.at<cv::Vec2f>(row, column); }
  const cv::Vec2f* row(int row) const { return rays_.ptr<cv::Vec2f>(row); }
  double focal() const { return focal_; }  ///< px

  /// An image of the recording as a source gives it to the stages: undistorted with the nearest
  /// pixel, and cropped.
  cv::Mat rectified(const cv::Mat& image) const;

 private:
  cv::Mat rays_;  // CV_32FC2
  cv::Mat map_;   // CV_32FC2, empty: nothing to be done
  double focal_;
};

/// The frame that people's plans are made in: origin where the recording's first camera is, but on
/// the floor (world height `floor`); x to its right, y ahead of it, z up.
Pose world_from_level(const Pose& world_from_first_camera, double floor);

}  // namespace stillpoint::people
