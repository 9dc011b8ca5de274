// What the tracker finds in the frames.
#pragma once

#include <vector>

#include "figures/course.hpp"

namespace stillpoint::figures {

/// Numbers of features over time.
struct RunFeatures {
  Course extracted, matched, inliers;
  std::vector<Range> lost;  ///< stretches of time without poses, s
};

/// As wide as a column.
Figure feature_figure(const RunFeatures& run);

}  // namespace stillpoint::figures
