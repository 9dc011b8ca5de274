#include "figures/share_figure.hpp"

namespace stillpoint::figures {

Figure share_figure(std::span<const RunShare> runs) {
  constexpr double kHeightPt = 70, kPercent = 100;
  Panel panel{"Share of the image left out", {"time [s]"}, {"excluded [%]"}};
  panel.y.low = 0;
  Range times = empty_range();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    mark_lost(panel, runs[k].lost, k, runs.size());
    Line line = run_line(runs[k].name, points_of(runs[k].excluded, runs[k].lost, kPercent), k);
    line.filled = runs.size() == 1;
    panel.marks.emplace_back(std::move(line));
    for (const double second : runs[k].excluded.seconds) times.include(second);
  }
  limit_x(panel, times);
  Figure figure{"Share of the image left out"};
  figure.rows.push_back({kHeightPt, {std::move(panel)}});
  return figure;
}

}  // namespace stillpoint::figures
