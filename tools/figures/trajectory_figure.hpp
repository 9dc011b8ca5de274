// Trajectories beside the true one, as in Figs. 3 and 4 of the DS-SLAM paper.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "figures/figure.hpp"

namespace stillpoint::figures {

/// Poses of a run beside the true ones: metres, in the world of the truth, where z points up.
/// Without truth, in the run's own world.
struct RunPath {
  std::string name;
  std::vector<double> seconds;         ///< rising, since the recording began
  std::vector<Eigen::Vector3d> truth;  ///< empty: not known
  std::vector<Eigen::Vector3d> estimate;
  std::vector<Range> lost;  ///< stretches of time without poses

  std::vector<double> errors_m() const;  ///< empty without truth
};

/// The planes x–y and x–z, as wide as a column: which of them is the floor is up to the world. A
/// single run has the colours of its error, of several each has its own. At least one, with at
/// least one pose.
Figure trajectory_figure(std::span<const RunPath> runs);

/// The two views for other figures; the colour scale of a single run comes with them.
Panel view_along(std::span<const RunPath> runs, int horizontal, int vertical);
std::optional<ColourScale> error_colours(std::span<const RunPath> runs);

/// Height of axes `width_pt` wide in which the view along z (vertical 1) or y (2) has equal scales,
/// within limits.
double view_height_pt(std::span<const RunPath> runs, int vertical, double width_pt);

/// The run that shows most of the truth.
const RunPath& longest_of(std::span<const RunPath> runs);

}  // namespace stillpoint::figures
