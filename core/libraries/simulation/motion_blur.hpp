// How the image moves during the exposure, and the blur where it moves as a whole.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace stillpoint::simulation {

/// The motions found in a part of the image, px during the exposure.
struct MotionRange {
  Eigen::Vector2f low = Eigen::Vector2f::Zero();
  Eigen::Vector2f high = Eigen::Vector2f::Zero();

  void include(const MotionRange& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  Eigen::Vector2f mean() const { return 0.5F * (low + high); }
  float fastest() const;                                ///< at most, px
  float spread() const { return (high - low).norm(); }  ///< px
};

/// Motion by tiles of a few pixels. Tiles may be set by several threads.
class MotionMap {
 public:
  MotionMap(int columns, int rows)
      : columns_(columns), rows_(rows), tiles_(static_cast<std::size_t>(columns * rows)) {}

  MotionRange& at(int column, int row) {
    return tiles_[static_cast<std::size_t>(row) * columns_ + column];
  }
  const MotionRange& at(int column, int row) const {
    return tiles_[static_cast<std::size_t>(row) * columns_ + column];
  }
  /// Motion in every tile and in those near enough to come there during the exposure.
  MotionMap widened() const;

 private:
  int columns_;
  int rows_;
  std::vector<MotionRange> tiles_;
};

/// Mean of a CV_32FC3 image along `motion` px, with `pixel` in the middle.
cv::Vec3f mean_along(const cv::Mat& image, const cv::Point& pixel, const Eigen::Vector2f& motion);

}  // namespace stillpoint::simulation
