#include "figures/trajectory_figure.hpp"

#include <algorithm>

#include "figures/course.hpp"

namespace stillpoint::figures {
namespace {

constexpr double kTruthPt = 2.0;
constexpr const char* kAxisLabel[3] = {"x [m]", "y [m]", "z [m]"};

struct Flat {
  Points points;
  std::vector<double> values;
};

/// Two of the three coordinates; a value for each point, those of breaks included.
Flat flatten(const RunPath& run, const std::vector<Eigen::Vector3d>& path,
             const std::vector<double>& values, int horizontal, int vertical) {
  Flat flat;
  const auto add = [&](const Eigen::Vector2d& point, double value) {
    flat.points.push_back(point);
    flat.values.push_back(value);
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0 && lost_between(run.lost, run.seconds[i - 1], run.seconds[i])) add(line_break(), 0);
    add({path[i][horizontal], path[i][vertical]}, values[i]);
  }
  return flat;
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
  if (runs.size() != 1) return std::nullopt;
  const double largest = largest_of(runs[0].errors_m());
  const LengthUnit unit = unit_for(largest);
  constexpr double kNoErrorM = 1e-6;
  return ColourScale{"error [" + unit.name + "]",
                     {0, unit.per_metre * std::max(largest, kNoErrorM)}};
}

Panel view_along(std::span<const RunPath> runs, int horizontal, int vertical) {
  Panel panel{vertical == 1 ? "From above" : "From the side",
              {kAxisLabel[horizontal]},
              {kAxisLabel[vertical]},
              {},
              true};
  const RunPath& longest = longest_of(runs);
  const std::vector<double> no_values(longest.truth.size());
  panel.marks.emplace_back(
      Line{"truth", flatten(longest, longest.truth, no_values, horizontal, vertical).points,
           kReferenceGrey, kTruthPt});
  for (std::size_t k = 0; k < runs.size(); ++k) {
    std::vector<double> errors = runs[k].errors_m();
    const double per_metre = unit_for(largest_of(errors)).per_metre;
    for (double& error : errors) error *= per_metre;
    Flat flat = flatten(runs[k], runs[k].estimate, errors, horizontal, vertical);
    if (runs.size() == 1)
      panel.marks.emplace_back(ValueLine{std::move(flat.points), std::move(flat.values)});
    else
      panel.marks.emplace_back(Line{runs[k].name, std::move(flat.points), run_colour(k)});
  }
  const Eigen::Vector3d& start = longest.truth.front();
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
