// FAST-9 corners (Rosten and Drummond, ECCV 2006) with their scores, at one threshold for the whole
// image.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

namespace stillpoint::orb_slam {

/// A corner that no neighbour in 3 × 3 pixels exceeds.
struct Corner {
  int x = 0, y = 0;  ///< px
  /// Grey levels by which the best arc of nine differs at least from the centre: the pixel is a
  /// FAST corner for every threshold below it.
  int score = 0;

  bool operator==(const Corner&) const = default;
};

/// Peak of the scores around a corner, in px. The corner must lie 18 px inside `gray`.
cv::Point2d refine_corner(const cv::Mat& gray, const Corner& corner);

/// Keeps its row buffers between calls; one object per thread.
class FastDetector {
 public:
  /// Smallest border that `detect` allows: the circle, a neighbour, and the slack of reading in
  /// blocks of 16 pixels.
  static constexpr int kMinBorder = 5;

  /// Corners with score > `threshold` at least `border` px inside `gray` (CV_8UC1), row by row.
  /// Of equal neighbours the first one counts. `corners` is overwritten.
  void detect(const cv::Mat& gray, int threshold, int border, std::vector<Corner>& corners);

 private:
  std::vector<std::uint8_t> rows_;  // scores of the last three rows
};

}  // namespace stillpoint::orb_slam
