#include "figures/feature_figure.hpp"

#include <string>
#include <utility>

namespace stillpoint::figures {

Figure feature_figure(const RunFeatures& run) {
  constexpr double kHeightPt = 75, kThinPt = 0.9;
  Panel panel{"", {"time [s]"}, {"features"}};
  panel.y.low = 0;
  mark_lost(panel, run.lost, 0, 1);
  Range times = empty_range();
  const auto add = [&](const std::string& name, const Course& course, const Colour& colour) {
    panel.marks.emplace_back(Line{name, points_of(course, {}), colour, kThinPt});
    for (const double second : course.seconds) times.include(second);
  };
  add("extracted", run.extracted, kReferenceGrey);
  add("matched", run.matched, run_colour(0));
  add("inliers", run.inliers, run_colour(2));
  limit_x(panel, times);
  Figure figure{"Features"};
  figure.rows.push_back({kHeightPt, {std::move(panel)}});
  return figure;
}

}  // namespace stillpoint::figures
