#include "figures/time_figure.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

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

/// Their colours, in the order of the pipeline: for the costliest of any run; grey for the others.
std::map<std::string, Colour> stage_colours(std::span<const RunTimes> runs) {
  std::map<std::string, double> costs;
  for (const RunTimes& run : runs)
    for (const StageTime& time : run.stages)
      costs[time.stage] = std::max(costs[time.stage], time.mean_per_frame);
  std::vector<double> falling;
  for (const auto& [stage, cost] : costs) falling.push_back(cost);
  std::ranges::sort(falling, std::greater<>());
  const double least = falling.size() > kPartColours ? falling[kPartColours - 1] : 0;
  std::map<std::string, Colour> colours;
  std::size_t used = 0;
  for (const std::string& stage : stage_names(runs))
    colours[stage] = costs[stage] >= least ? part_colour(used++) : kOtherPartsGrey;
  return colours;
}

/// The others are one piece at the end.
void stack_stages(Panel& panel, const RunTimes& run, const std::map<std::string, Colour>& colours) {
  const auto row = static_cast<double>(panel.y.categories.size());
  double from = 0, others = 0;
  const auto add = [&](const std::string& name, double ms, const Colour& colour) {
    panel.marks.emplace_back(Bar{name, {from, from + ms}, row, 0.7, colour});
    from += ms;
  };
  for (const StageTime& time : run.stages) {
    const Colour& colour = colours.at(time.stage);
    if (colour == kOtherPartsGrey)
      others += time.mean_per_frame;
    else
      add(time.stage, time.mean_per_frame, colour);
  }
  if (others > 0) add("other stages", others, kOtherPartsGrey);
  panel.y.categories.push_back(run.name);
}

Panel stacked_means(std::span<const RunTimes> runs, const std::map<std::string, Colour>& colours) {
  Panel panel{"CPU time of a frame, mean", {}, {}};
  panel.x.low = 0;
  for (const RunTimes& run : runs) stack_stages(panel, run, colours);
  return panel;
}

double height_pt(std::size_t categories) {
  return kCategoryPt * static_cast<double>(std::max<std::size_t>(categories, 1));
}

/// A bar to the median, ever thinner ones to the other two. `name` for the legend.
void add_percentiles(Panel& panel, const std::string& name, const StageTime& time, double y,
                     double thickness, const Colour& colour) {
  const auto bar = [&](const std::string& legend, double from, double to, double part) {
    panel.marks.emplace_back(Bar{legend, {from, to}, y, part * thickness, colour});
  };
  bar(name, 0, time.p50, 1.0);
  bar({}, time.p50, time.p95, 0.45);
  bar({}, time.p95, time.p99, 0.12);
}

Panel percentiles(std::span<const RunTimes> runs, const std::map<std::string, Colour>& colours) {
  constexpr double kOfCategory = 0.75;
  Panel panel{"Wall time of a call: median, 95th, 99th percentile", {"time [ms]"}, {}};
  panel.x.low = 0;
  panel.y.categories = stage_names(runs);
  const double thickness = kOfCategory / static_cast<double>(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const StageTime& time : runs[k].stages) {
      const auto place = std::ranges::find(panel.y.categories, time.stage);
      const double y = static_cast<double>(place - panel.y.categories.begin()) - kOfCategory / 2 +
                       (static_cast<double>(k) + 0.5) * thickness;
      if (runs.size() == 1)
        add_percentiles(panel, {}, time, y, thickness, colours.at(time.stage));
      else  // a little apart
        add_percentiles(panel, runs[k].name, time, y, 0.9 * thickness, run_colour(k));
    }
  return panel;
}

double sum_of(const StageCourse& stage) {
  return std::accumulate(stage.ms.begin(), stage.ms.end(), 0.0);
}

/// As many as lines can be told apart, in their order.
std::vector<StageCourse> costliest(std::span<const StageCourse> stages) {
  std::vector<double> falling;
  for (const StageCourse& stage : stages) falling.push_back(sum_of(stage));
  std::ranges::sort(falling, std::greater<>());
  const double least = falling.size() > kRunColours ? falling[kRunColours - 1] : 0;
  std::vector<StageCourse> result;
  std::ranges::copy_if(stages, std::back_inserter(result),
                       [least](const StageCourse& stage) { return sum_of(stage) >= least; });
  return result;
}

}  // namespace

Figure stage_time_figure(std::span<const RunTimes> runs) {
  const std::map<std::string, Colour> colours = stage_colours(runs);
  Figure figure{"Time of the stages"};
  figure.rows.push_back({height_pt(runs.size()), {stacked_means(runs, colours)}});
  figure.rows.push_back({height_pt(colours.size()), {percentiles(runs, colours)}});
  return figure;
}

Figure variant_time_figure(std::span<const RunTimes> variants) {
  Figure figure{"Time of the stages"};
  figure.rows.push_back(
      {height_pt(variants.size()), {stacked_means(variants, stage_colours(variants))}});
  return figure;
}

Figure frame_time_figure(std::span<const StageCourse> stages) {
  constexpr double kHeightPt = 110, kThinPt = 0.7;
  Panel panel{"", {"frame"}, {"CPU [ms]"}};
  panel.y.low = 0;
  Range frames = empty_range();
  for (const StageCourse& stage : costliest(stages)) {
    panel.marks.emplace_back(Line{stage.stage, points_of({stage.frames, stage.ms}, {}),
                                  run_colour(panel.marks.size()), kThinPt});
    for (const double frame : stage.frames) frames.include(frame);
  }
  limit_x(panel, frames);
  Figure figure{"CPU time of the stages", kPagePt};
  figure.rows.push_back({kHeightPt, {std::move(panel)}});
  return figure;
}

}  // namespace stillpoint::figures
