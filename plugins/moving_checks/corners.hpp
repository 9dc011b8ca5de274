// Which points to track: Shi–Tomasi corners (CVPR 1994), the strongest or one per grid cell.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <span>
#include <vector>

#include "stillpoint/options.hpp"

namespace stillpoint::moving_checks {

struct CornerOptions {
  enum class Method { kGrid, kShiTomasi } corners = Method::kGrid;
  int max_corners = 300;
  double min_gradient = 4.0;  ///< grey levels per px of the half image, in every direction: `grid`
  double corner_quality = 0.01;  ///< of the strongest corner's score: `shi_tomasi`
  double min_distance = 8.0;     ///< px, between corners: `shi_tomasi`

  void visit(OptionVisitor& v);
};

/// Points to track in an image (CV_8UC1). `half` is the same image at half the size, in which
/// `grid` looks for corners: tracking needs texture, not the exact position of the corner.
///
/// `kept` are points that are followed already: `grid` returns those that still have texture first,
/// one per cell, and fills the other cells with new corners. `kept_index` tells which is which
/// (-1: new).
struct Corners {
  std::vector<cv::Point2f> points;
  std::vector<int> kept_index;
};
Corners find_corners(const cv::Mat& gray, const cv::Mat& half, std::span<const cv::Point2f> kept,
                     double border, const CornerOptions& options);

}  // namespace stillpoint::moving_checks
