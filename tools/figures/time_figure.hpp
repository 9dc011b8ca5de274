// What the stages of a run cost.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "figures/course.hpp"

namespace stillpoint::figures {

/// Milliseconds.
struct StageTime {
  std::string stage;
  double mean_per_frame = 0;         ///< CPU time, over all frames, also those without the stage
  double p50 = 0, p95 = 0, p99 = 0;  ///< percentiles of its calls, wall time
};

struct RunTimes {
  std::string name;
  std::vector<StageTime> stages;  ///< in the order of the pipeline
};

/// Above, what an average frame costs, a bar of stages for each run, those of little cost in one
/// piece; below, the percentiles of each stage: 50th (bar), 95th (narrower) and 99th (line). As
/// wide as a column.
Figure stage_time_figure(std::span<const RunTimes> runs);

/// The part above alone, for the means of many runs; percentiles are not used.
Figure variant_time_figure(std::span<const RunTimes> variants);

/// CPU time of the frames, ms; `frames` rise.
struct StageCourse {
  std::string stage;
  std::vector<double> frames, ms;
};

/// A line for each of the costliest stages, as wide as the page.
Figure frame_time_figure(std::span<const StageCourse> stages);

}  // namespace stillpoint::figures
