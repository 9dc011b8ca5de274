// What does move: points followed from the previous frame (paper III-C).
#pragma once

#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

#include "stillpoint/pose_math.hpp"

namespace stillpoint {

/// One point followed from the previous frame to the current one.
struct PointMotion {
  cv::Point2f previous;   ///< px
  cv::Point2f current;    ///< px
  float residual = 0.0f;  ///< px from where the camera's motion alone predicts it
  bool moving = false;
};

struct MovingPoints {
  std::vector<PointMotion> points;
  /// False when the check was inconclusive (first frame, too few points, degenerate motion); such
  /// points must not be used.
  bool reliable = false;
  /// The camera's own motion, current_from_previous, where the check has found it.
  std::optional<Pose> camera_motion;
};

}  // namespace stillpoint
