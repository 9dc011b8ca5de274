#include "figures/error_figure.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::figures {
namespace {

using CourseOf = Course RunErrors::*;

Panel panel_of(std::span<const RunErrors> runs, CourseOf course, const std::string& title,
               const std::string& label, double scale) {
  Panel panel{title, {"time [s]"}, {label}};
  panel.y.low = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    mark_lost(panel, runs[k].lost, k, runs.size());
    for (const double loop : runs[k].loops_s)
      panel.marks.emplace_back(Stretch{"loop closed", {loop, loop}, kInk});
  }
  for (std::size_t k = 0; k < runs.size(); ++k)
    panel.marks.emplace_back(
        run_line(runs[k].name, points_of(runs[k].*course, runs[k].lost, scale), k));
  return panel;
}

Panel length_panel(std::span<const RunErrors> runs, CourseOf course, const std::string& title,
                   const std::string& label) {
  double largest = 0;
  for (const RunErrors& run : runs) largest = std::max(largest, largest_of((run.*course).values));
  const LengthUnit unit = unit_for(largest);
  return panel_of(runs, course, title, label + " [" + unit.name + "]", unit.per_metre);
}

Line rms_line(const Course& course, double per_metre) {
  double squares = 0;
  for (const double value : course.values) squares += value * value;
  const double rms =
      per_metre *
      std::sqrt(squares / static_cast<double>(std::max<std::size_t>(course.values.size(), 1)));
  return {"RMSE", {{course.seconds.front(), rms}, {course.seconds.back(), rms}}, kInk, 0.8, true};
}

/// All panels reach over all times of all runs.
void share_times(std::span<const RunErrors> runs, std::vector<Row>& rows) {
  Range times = empty_range();
  for (const RunErrors& run : runs) {
    for (const Course* course : {&run.absolute_m, &run.relative_m, &run.relative_deg})
      for (const double second : course->seconds) times.include(second);
    for (const Range& stretch : run.lost) {
      times.include(stretch.low);
      times.include(stretch.high);
    }
  }
  for (Row& row : rows) limit_x(row.panels[0], times);
}

}  // namespace

Panel absolute_error_panel(std::span<const RunErrors> runs) {
  Panel panel = length_panel(runs, &RunErrors::absolute_m, "Absolute error", "ATE");
  if (runs.size() == 1 && !runs[0].absolute_m.seconds.empty())
    panel.marks.emplace_back(
        rms_line(runs[0].absolute_m, unit_for(largest_of(runs[0].absolute_m.values)).per_metre));
  return panel;
}

Figure error_figure(std::span<const RunErrors> runs, const std::string& interval) {
  constexpr double kHeightPt = 62;
  const std::string over = " over " + interval;
  Figure figure{"Errors over time"};
  figure.rows.push_back({kHeightPt, {absolute_error_panel(runs)}});
  figure.rows.push_back(
      {kHeightPt, {length_panel(runs, &RunErrors::relative_m, "Relative error" + over, "RPE")}});
  figure.rows.push_back({kHeightPt,
                         {panel_of(runs, &RunErrors::relative_deg,
                                   "Relative error of rotation" + over, "RPE [deg]", 1)}});
  for (Row& row : std::span(figure.rows).first(figure.rows.size() - 1)) {
    row.panels[0].x.label.clear();
    row.panels[0].x.numbers = false;
  }
  share_times(runs, figure.rows);
  return figure;
}

}  // namespace stillpoint::figures
