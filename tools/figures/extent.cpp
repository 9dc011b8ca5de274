#include "figures/extent.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::figures {
namespace {

constexpr double kMargin = 0.05;     // of the range, free on either side
constexpr double kLeastSpan = 1e-6;  // of the largest number: less is none
constexpr double kWide = 1e-3;       // of the largest number: the span of nothing, at least 1

void include_points(Range& range, const Points& points, int axis) {
  for (const Eigen::Vector2d& point : points)
    if (point.allFinite()) range.include(point[axis]);
}

struct Extent {
  Range range;
  int axis;

  void operator()(const Line& line) {
    include_points(range, line.points, axis);
    if (line.filled && axis == 1) range.include(0);
  }
  void operator()(const ValueLine& line) { include_points(range, line.points, axis); }
  void operator()(const Dot& dot) { range.include(dot.at[axis]); }
  void operator()(const Stretch& stretch) {
    if (axis == 0) include_ends(stretch.x);
  }
  void operator()(const Bar& bar) {
    if (axis == 0) include_ends(bar.x);
  }

 private:
  void include_ends(const Range& x) {
    range.include(x.low);
    range.include(x.high);
  }
};

double largest_number(const Range& range) {
  return std::max(std::abs(range.low), std::abs(range.high));
}

double span_of_nothing(const Range& range) { return std::max(1.0, kWide * largest_number(range)); }

Range with_margin(const Range& range) {
  if (range.low > range.high) return {0, 1};  // no data
  const double margin = range.span() <= kLeastSpan * largest_number(range)
                            ? span_of_nothing(range) / 2
                            : kMargin * range.span();
  return {range.low - margin, range.high + margin};
}

}  // namespace

Range range_along(const Panel& panel, int axis) {
  constexpr double kBesideCategory = 0.6;
  const Axis& description = axis == 0 ? panel.x : panel.y;
  if (!description.categories.empty())
    return {static_cast<double>(description.categories.size()) - 1 + kBesideCategory,
            -kBesideCategory};
  Extent extent{empty_range(), axis};
  for (const Mark& mark : panel.marks) std::visit(extent, mark);
  Range range = with_margin(extent.range);
  if (description.low) range.low = *description.low;
  if (description.high) range.high = *description.high;
  if (range.span() <= 0) range.high = range.low + span_of_nothing(range);
  return range;
}

void equalise(Range& x, Range& y, const Box& axes) {
  const double units_per_pt = std::max(x.span() / axes.width, y.span() / axes.height);
  const auto widen = [units_per_pt](Range& range, double pt) {
    const double missing = (units_per_pt * pt - range.span()) / 2;
    range = {range.low - missing, range.high + missing};
  };
  widen(x, axes.width);
  widen(y, axes.height);
}

}  // namespace stillpoint::figures
