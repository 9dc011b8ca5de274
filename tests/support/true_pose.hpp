// Where the camera of a recording was, from its groundtruth.txt.
#pragma once

#include <algorithm>

#include "evaluation/trajectory.hpp"

namespace stillpoint {

/// At any time (seconds), between two rows of the file or beyond its ends.
inline Pose pose_at(const evaluation::Trajectory& truth, double time) {
  std::size_t i = 1;
  while (i + 1 < truth.poses.size() && truth.poses[i].time < time) ++i;
  const auto& [before, a] = truth.poses[i - 1];
  const auto& [after, b] = truth.poses[i];
  return interpolate(a, b, std::clamp((time - before) / (after - before), 0.0, 1.0));
}

}  // namespace stillpoint
