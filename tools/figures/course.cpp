#include "figures/course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace stillpoint::figures {

Points points_of(const Course& course, const std::vector<Range>& lost, double scale) {
  Points points;
  for (std::size_t i = 0; i < course.seconds.size(); ++i) {
    if (i > 0 && lost_between(lost, course.seconds[i - 1], course.seconds[i]))
      points.push_back(line_break());
    points.emplace_back(course.seconds[i], scale * course.values[i]);
  }
  return points;
}

bool lost_between(const std::vector<Range>& lost, double earlier, double later) {
  return std::ranges::any_of(
      lost, [&](const Range& stretch) { return stretch.low < later && stretch.high > earlier; });
}

Eigen::Vector2d line_break() {
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

Line run_line(const std::string& name, Points points, std::size_t run) {
  Line line{name, std::move(points), run_colour(run)};
  line.dashed = run / kRunColours % 2 == 1;
  return line;
}

void mark_lost(Panel& panel, const std::vector<Range>& lost, std::size_t run, std::size_t runs) {
  for (const Range& stretch : lost) {
    Stretch mark{"no pose", stretch};
    if (runs > 1) {
      mark.lane = static_cast<int>(run);
      mark.colour = run_colour(run);
    }
    panel.marks.emplace_back(std::move(mark));
  }
}

void limit_x(Panel& panel, const Range& times) {
  if (times.low >= times.high) return;
  panel.x.low = times.low;
  panel.x.high = times.high;
}

LengthUnit unit_for(double largest_m) {
  return largest_m > 1 ? LengthUnit{"m", 1} : LengthUnit{"mm", 1000};
}

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, value);
  return largest;
}

}  // namespace stillpoint::figures
