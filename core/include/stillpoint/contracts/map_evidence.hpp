// Where a depth image agrees with what was seen before, and where it does not.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillpoint {

struct MapEvidence {
  /// CV_32FC1, log-odds that the surface in a cell moves, from its place alone: > 0 where something
  /// stands that earlier frames looked through, < 0 where it stands as they saw it, 0 where nothing
  /// is known. Cells are squares of pixels that cover the frame. Empty: nothing is known anywhere.
  cv::Mat log_odds;
};

}  // namespace stillpoint
