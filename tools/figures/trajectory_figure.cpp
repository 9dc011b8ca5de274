#include "figures/trajectory_figure.hpp"

#include <algorithm>
#include <utility>

#include "figures/course.hpp"

namespace stillpoint::figures {
namespace {

constexpr double kTruthPt = 2.0;
constexpr const char* kAxisLabel[3] = {"x [m]", "y [m]", "z [m]"};

bool breaks_before(const RunPath& run, std::size_t i) {
  return i > 0 && lost_between(run.lost, run.seconds[i - 1], run.seconds[i]);
}

/// Two of the three coordinates.
Points points_of(const RunPath& run, const std::vector<Eigen::Vector3d>& path, int horizontal,
                 int vertical) {
  Points points;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (breaks_before(run, i)) points.push_back(line_break());
    points.emplace_back(path[i][horizontal], path[i][vertical]);
  }
  return points;
}

/// Errors in the unit of the colour scale, one for each of the points.
std::vector<double> values_of(const RunPath& run) {
  const std::vector<double> errors = run.errors_m();
  const double per_metre = unit_for(largest_of(errors)).per_metre;
  std::vector<double> values;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (breaks_before(run, i)) values.push_back(0);
    values.push_back(per_metre * errors[i]);
  }
  return values;
}

double span_along(std::span<const RunPath> runs, int axis) {
  Range range = empty_range();
  for (const RunPath& run : runs)
    for (const auto* path : {&run.truth, &run.estimate})
      for (const Eigen::Vector3d& point : *path) range.include(point[axis]);
  return std::max(range.span(), 0.0);
}

}  // namespace

std::vector<double> RunPath::errors_m() const {
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.size(); ++i) errors.push_back((estimate[i] - truth[i]).norm());
  return errors;
}

const RunPath& longest_of(std::span<const RunPath> runs) {
  return *std::ranges::max_element(runs, {}, [](const RunPath& run) { return run.seconds.size(); });
}

std::optional<ColourScale> error_colours(std::span<const RunPath> runs) {
  if (runs.size() != 1 || runs[0].truth.empty()) return std::nullopt;
  const double largest = largest_of(runs[0].errors_m());
  const LengthUnit unit = unit_for(largest);
  constexpr double kNoErrorM = 1e-6;
  return ColourScale{"error [" + unit.name + "]",
                     {0, unit.per_metre * std::max(largest, kNoErrorM)}};
}

Panel view_along(std::span<const RunPath> runs, int horizontal, int vertical) {
  Panel panel{"", {kAxisLabel[horizontal]}, {kAxisLabel[vertical]}, {}, true};
  const RunPath& longest = longest_of(runs);
  if (!longest.truth.empty())
    panel.marks.emplace_back(Line{"truth", points_of(longest, longest.truth, horizontal, vertical),
                                  kReferenceGrey, kTruthPt});
  const std::optional<ColourScale> colours = error_colours(runs);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    Points points = points_of(runs[k], runs[k].estimate, horizontal, vertical);
    if (colours)
      panel.marks.emplace_back(ValueLine{std::move(points), values_of(runs[k])});
    else
      panel.marks.emplace_back(run_line(runs[k].name, std::move(points), k));
  }
  const Eigen::Vector3d& start =
      longest.truth.empty() ? longest.estimate.front() : longest.truth.front();
  panel.marks.emplace_back(Dot{"start", {start[horizontal], start[vertical]}});
  return panel;
}

double view_height_pt(std::span<const RunPath> runs, int vertical, double width_pt) {
  constexpr double kLowest = 60, kHighest = 1.2, kLeastM = 1e-3;
  const double width_m = std::max(span_along(runs, 0), kLeastM);
  return std::clamp(width_pt * span_along(runs, vertical) / width_m, kLowest, kHighest * width_pt);
}

Figure trajectory_figure(std::span<const RunPath> runs) {
  constexpr double kAxesPt = 175;  // about as wide as they become
  Figure figure{"Trajectories"};
  for (const int vertical : {1, 2})
    figure.rows.push_back(
        {view_height_pt(runs, vertical, kAxesPt), {view_along(runs, 0, vertical)}});
  figure.rows[0].panels[0].x.label.clear();
  figure.colour_scale = error_colours(runs);
  return figure;
}

}  // namespace stillpoint::figures
