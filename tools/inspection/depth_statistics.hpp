// What the depth images of a recording contain.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace stillpoint::inspection {

/// Counts raw depth values over many images.
class DepthStatistics {
 public:
  void add(const cv::Mat& raw);  ///< CV_16UC1

  int images() const { return images_; }
  int empty_images() const { return empty_images_; }  ///< without a single measurement
  /// Share of pixels with a measurement.
  double valid_share() const;
  /// Raw value below which `share` of the measurements lie; 0 without any.
  int quantile(double share) const;
  /// Share of the measurements in [from, to) metres.
  double share_between(double from, double to, double depth_factor) const;

 private:
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(65536);
  std::uint64_t pixels_ = 0;
  int images_ = 0;
  int empty_images_ = 0;
};

}  // namespace stillpoint::inspection
