#include "figures/evaluation_figure.hpp"

#include <algorithm>

#include "evaluation/format.hpp"
#include "figures/course.hpp"
#include "figures/error_figure.hpp"
#include "stillpoint/support/median.hpp"

namespace stillpoint::figures {
namespace {

using evaluation::Contestant;

std::string name_with_figures(const Contestant& run) {
  constexpr double kMillimetres = 1000;
  return run.name + ": ATE RMSE " + evaluation::fixed(kMillimetres * run.error.metres.rmse, 1) +
         " mm, " + std::to_string(run.evaluation.pairs.size()) + " poses";
}

RunPath path_of(const Contestant& run) {
  const evaluation::Evaluation& e = run.evaluation;
  RunPath path;
  path.name = name_with_figures(run);
  for (const auto& [r, i] : e.pairs) {
    path.seconds.push_back(e.reference.poses[r].time - e.reference.start());
    path.truth.push_back(e.reference.poses[r].world_from_camera.translation());
    path.estimate.push_back(
        evaluation::aligned(run.error.reference_from_estimate, e.estimate.poses[i]));
  }
  return path;
}

/// Stretches of `whole` longer than three usual intervals without a pose.
std::vector<Range> lost_stretches(const std::vector<double>& seconds, const Range& whole) {
  constexpr double kGapIntervals = 3;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < seconds.size(); ++i) intervals.push_back(seconds[i] - seconds[i - 1]);
  const double longest = kGapIntervals * median(std::move(intervals));
  std::vector<Range> lost;
  const auto add = [&](double from, double to) {
    if (to - from > longest) lost.push_back({from, to});
  };
  add(whole.low, seconds.front());
  for (std::size_t i = 1; i < seconds.size(); ++i) add(seconds[i - 1], seconds[i]);
  add(seconds.back(), whole.high);
  return lost;
}

Panel along_axis(std::span<const RunPath> runs, int axis, const Range& times) {
  constexpr const char* kTitle[3] = {"x", "y", "z"};
  constexpr double kTruthPt = 2.0;
  Panel panel{kTitle[axis], {"time [s]"}, {axis == 0 ? "[m]" : ""}};
  limit_x(panel, times);
  const auto coordinate = [axis](const RunPath& run, const std::vector<Eigen::Vector3d>& path) {
    Course course{run.seconds, {}};
    for (const Eigen::Vector3d& point : path) course.values.push_back(point[axis]);
    return points_of(course, run.lost);
  };
  const RunPath& longest = longest_of(runs);
  panel.marks.emplace_back(
      Line{"truth", coordinate(longest, longest.truth), kReferenceGrey, kTruthPt});
  for (std::size_t k = 0; k < runs.size(); ++k)
    panel.marks.emplace_back(run_line(runs[k].name, coordinate(runs[k], runs[k].estimate), k));
  return panel;
}

}  // namespace

Figure evaluation_figure(std::span<const Contestant> runs) {
  constexpr double kAxesPt = 195, kAxisPt = 70, kErrorPt = 80;
  std::vector<RunPath> paths;
  Range times = empty_range();
  for (const Contestant& run : runs) {
    paths.push_back(path_of(run));
    times.include(paths.back().seconds.front());
    times.include(paths.back().seconds.back());
  }
  std::vector<RunErrors> errors;
  for (RunPath& path : paths) {
    path.lost = lost_stretches(path.seconds, times);
    errors.push_back({path.name, {path.seconds, path.errors_m()}, {}, {}, path.lost, {}});
  }
  Figure figure{"Trajectories and their errors", kPagePt};
  const double view_pt =
      std::max(view_height_pt(paths, 1, kAxesPt), view_height_pt(paths, 2, kAxesPt));
  figure.rows.push_back({view_pt, {view_along(paths, 0, 1), view_along(paths, 0, 2)}});
  figure.rows.push_back({kAxisPt, {}});
  for (int axis = 0; axis < 3; ++axis)
    figure.rows[1].panels.push_back(along_axis(paths, axis, times));
  Panel error = absolute_error_panel(errors);
  limit_x(error, times);
  figure.rows.push_back({kErrorPt, {std::move(error)}});
  figure.colour_scale = error_colours(paths);
  return figure;
}

}  // namespace stillpoint::figures
