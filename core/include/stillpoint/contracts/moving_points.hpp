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
  float residual = 0.0f;  ///< px off the place that the camera's motion alone explains
  bool moving = false;
};

struct MovingPoints {
  std::vector<PointMotion> points;
  /// False when the check could not tell (first frame, too few points, degenerate motion); nothing
  /// may be decided from such points.
  bool reliable = false;
  /// The camera's own motion, current_from_previous, where the check has found it.
  std::optional<Pose> camera_motion;
};

}  // namespace stillpoint
