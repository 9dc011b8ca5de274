// Where a depth image agrees with earlier frames, and where it violates their free space.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillpoint {

struct MapEvidence {
  /// CV_32FC1, log-odds that the surface in a cell moves, from its position alone: > 0 for a
  /// free-space violation (earlier frames saw free space there), < 0 where earlier frames saw the
  /// same surface, 0 where nothing is known. Cells are squares of pixels, as large as the checker
  /// likes: with s pixels to a side, the one in row r and column c begins at pixel (s c, s r), and
  /// there are width / s columns and height / s rows, rounded up or down. Empty: nothing is known
  /// anywhere.
  cv::Mat log_odds;
};

}  // namespace stillpoint
