// Turns images as recorded into images of an ideal pinhole camera.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "stillpoint/contracts/camera.hpp"

namespace stillpoint {

/// Undistorts, crops, and scales depth, with maps computed once. Images must have the size of the
/// camera model.
class Rectifier {
 public:
  explicit Rectifier(const CameraModel& model);

  /// The camera of the resulting images.
  const Camera& camera() const { return camera_; }

  /// Bilinear; what the sensor did not see is black.
  cv::Mat color(const cv::Mat& bgr) const;

  /// CV_16UC1 as recorded → CV_32FC1 metres, 0 = no measurement or out of range. Nearest neighbour:
  /// a mean over the edge of an object would be a point in empty space.
  cv::Mat depth(const cv::Mat& raw) const;

 private:
  cv::Rect crop_;
  Camera camera_;
  std::vector<float> metres_;  // by raw depth; 0 outside the usable range
  // Empty without distortion:
  cv::Mat color_map_;           // CV_16SC2: source pixel
  cv::Mat color_weights_;       // CV_16UC1: where between its neighbours
  std::vector<int> depth_map_;  // index of the source pixel, -1 = outside the image
};

}  // namespace stillpoint
