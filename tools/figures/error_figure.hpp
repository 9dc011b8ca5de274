// Errors over time.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "figures/course.hpp"

namespace stillpoint::figures {

struct RunErrors {
  std::string name;
  Course absolute_m;            ///< of the position, after the alignment
  Course relative_m;            ///< of the motion over an interval
  Course relative_deg;          ///< the same of its rotation
  std::vector<Range> lost;      ///< stretches of time without poses, s
  std::vector<double> loops_s;  ///< when a loop was closed
};

/// Absolute error (ATE), relative error (RPE) and its rotation, as wide as a column. `interval` of
/// the relative error as it stands in its title: "1 s".
Figure error_figure(std::span<const RunErrors> runs, const std::string& interval);

/// The absolute error alone, for other figures. A single run has its root mean square with it.
Panel absolute_error_panel(std::span<const RunErrors> runs);

}  // namespace stillpoint::figures
