#include "run_table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace stillpoint {
namespace {

constexpr const char* kRule =
    "  ───────────────────────────────────────────────────────────────────────\n";

template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), pattern, arguments...);
  return text.data();
}

}  // namespace

void RunTable::finish(const RunSummary& summary) {
  stages_.add(summary.times);
  tracking_ = tracking_statistics(summary);
  source_ = summary.source;
  keyframes_ = summary.map.keyframe_count();
  landmarks_ = summary.map.landmark_count();
  complete_ = summary.complete;
  dropped_ = summary.dropped_frames;
  dropped_reports_ = summary.dropped_reports;
  loops_ = summary.loops_closed;
  unlabelled_ = summary.unlabelled_frames;
  segmentation_failures_ = summary.segmentation_failures;
  segmentation_failure_ = summary.segmentation_failure;
  wall_seconds_ = summary.wall_seconds;
  cpu_seconds_ = summary.cpu_seconds;
  recorded_seconds_ = summary.recorded_seconds;
  seed_ = summary.seed;
  mode_ = summary.mode;
}

void RunTable::print(std::ostream& stream) const {
  stream << '\n';
  print_run(stream);
  print_stages(stream);
}

void RunTable::print_run(std::ostream& stream) const {
  const auto processed = static_cast<double>(std::max<std::size_t>(tracking_.processed, 1));
  stream << format("  frames    %zu, tracked %zu (%.1f %%), lost %zu time%s\n", tracking_.frames,
                   tracking_.tracked, 100.0 * tracking_.coverage(), tracking_.times_lost,
                   tracking_.times_lost == 1 ? "" : "s");
  if (tracking_.poorly_constrained > 0)
    stream << format("            %zu poorly constrained: some motion was unobservable\n",
                     tracking_.poorly_constrained);
  if (dropped_ > 0)
    stream << format("            %d dropped to keep the sensor's pace\n", dropped_);
  if (dropped_reports_ > 0)
    stream << format("            %d reports not given to outputs that were too slow\n",
                     dropped_reports_);
  if (source_.skipped > 0)
    stream << format("            %zu image%s left out\n", source_.skipped,
                     source_.skipped == 1 ? "" : "s");
  if (unlabelled_ > 0) stream << format("            %d without labels\n", unlabelled_);
  if (segmentation_failures_ > 0)
    stream << format("            the segmenter failed on %d: ", segmentation_failures_)
           << segmentation_failure_ << '\n';
  stream << format("  map       %zu key frames, %zu landmarks, %d loop%s closed\n", keyframes_,
                   landmarks_, loops_, loops_ == 1 ? "" : "s");
  stream << format("  speed     %.1f frames/s (%.1f s for a recording of %.1f s)\n",
                   static_cast<double>(tracking_.processed) / std::max(wall_seconds_, 1e-9),
                   wall_seconds_, recorded_seconds_);
  stream << format("  CPU       %.1f ms per frame, all threads\n", 1e3 * cpu_seconds_ / processed);
  stream << format("  memory    %.0f MiB at most\n", peak_memory_mib());
  stream << format("  mode      %s, seed %lld\n\n", mode_.c_str(), seed_);
}

void RunTable::print_stages(std::ostream& stream) const {
  const auto rows = stages_.rows();
  if (rows.empty()) return;
  stream << "  stage [ms]              n     mean      p50      p95      max   mean CPU\n" << kRule;
  for (const StageStatistics::Row& row : rows)
    stream << format("  %-18s %6zu %8.2f %8.2f %8.2f %8.2f   %8.2f\n", row.stage.c_str(), row.count,
                     row.wall.mean, row.wall.p50, row.wall.p95, row.wall.max, row.cpu.mean);
  stream << kRule;
}

}  // namespace stillpoint
