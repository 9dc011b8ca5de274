#include "figures/time_figure.hpp"

#include <algorithm>

namespace stillpoint::figures {
namespace {

constexpr double kCategoryPt = 13;  // height of a bar and the space around it

/// All stages, in the order in which they first occur.
std::vector<std::string> stage_names(std::span<const RunTimes> runs) {
  std::vector<std::string> names;
  for (const RunTimes& run : runs)
    for (const StageTime& time : run.stages)
      if (std::ranges::find(names, time.stage) == names.end()) names.push_back(time.stage);
  return names;
}

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

Panel stacked(std::span<const RunTimes> runs, const std::vector<std::string>& stages) {
  Panel panel{"Mean of a frame", {}, {}};
  panel.x.low = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    double from = 0;
    for (const StageTime& time : runs[k].stages) {
      const double to = from + time.mean_per_frame;
      panel.marks.emplace_back(Bar{time.stage,
                                   {from, to},
                                   static_cast<double>(k),
                                   0.7,
                                   part_colour(index_of(stages, time.stage))});
      from = to;
    }
    panel.y.categories.push_back(runs[k].name);
  }
  return panel;
}

/// Runs side by side within the place of a stage.
void add_percentiles(Panel& panel, const StageTime& time, double y, double thickness,
                     const Colour& colour) {
  const auto bar = [&](double from, double to, double part) {
    panel.marks.emplace_back(Bar{{}, {from, to}, y, part * thickness, colour});
  };
  bar(0, time.p50, 1.0);
  bar(time.p50, time.p95, 0.45);
  bar(time.p95, time.p99, 0.12);
}

Panel percentiles(std::span<const RunTimes> runs, const std::vector<std::string>& stages) {
  constexpr double kOfCategory = 0.75;
  Panel panel{"A call: median, 95th and 99th percentile", {"time [ms]"}, {}};
  panel.x.low = 0;
  panel.y.categories = stages;
  const double thickness = kOfCategory / static_cast<double>(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const StageTime& time : runs[k].stages) {
      const std::size_t stage = index_of(stages, time.stage);
      const double y =
          static_cast<double>(stage) - kOfCategory / 2 + (static_cast<double>(k) + 0.5) * thickness;
      add_percentiles(panel, time, y, 0.9 * thickness,
                      runs.size() == 1 ? part_colour(stage) : run_colour(k));
    }
  return panel;
}

}  // namespace

Figure stage_time_figure(std::span<const RunTimes> runs) {
  const std::vector<std::string> stages = stage_names(runs);
  const auto height = [](std::size_t categories) {
    return kCategoryPt * static_cast<double>(std::max<std::size_t>(categories, 1));
  };
  Figure figure{"Time of the stages"};
  figure.rows.push_back({height(runs.size()), {stacked(runs, stages)}});
  figure.rows.push_back({height(stages.size()), {percentiles(runs, stages)}});
  return figure;
}

Figure frame_time_figure(std::span<const StageCourse> stages) {
  constexpr double kHeightPt = 110, kThinPt = 0.6;
  Panel panel{"", {"time [s]"}, {"[ms]"}};
  panel.y.low = 0;
  Range times = empty_range();
  for (const StageCourse& stage : stages) {
    panel.marks.emplace_back(Line{stage.stage, points_of(stage.ms, {}),
                                  part_colour(static_cast<std::size_t>(&stage - stages.data())),
                                  kThinPt});
    for (const double second : stage.ms.seconds) times.include(second);
  }
  if (times.low < times.high) {
    panel.x.low = times.low;
    panel.x.high = times.high;
  }
  Figure figure{"Time of the stages over the run", kPagePt};
  figure.rows.push_back({kHeightPt, {std::move(panel)}});
  return figure;
}

}  // namespace stillpoint::figures
