#include "stillpoint/support/run_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numeric>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace stillpoint {
namespace {

constexpr std::array<std::string_view, 18> kPipelineOrder = {
    "source",     "prepare",     "moving_check", "map_check", "segmentation_wait", "segmentation",
    "propagate",  "beside_wait", "decision",     "track",     "track_thread",      "outputs",
    "map_insert", "map_refine",  "map_correct",  "loop",      "loop_adjust",       "dense"};

auto place_in_pipeline(const StageStatistics::Row& row) {
  return std::find(kPipelineOrder.begin(), kPipelineOrder.end(), row.stage);
}

}  // namespace

Distribution distribution_of(std::vector<float> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto size = static_cast<double>(values.size());
  const auto percentile = [&](double share) -> double {
    return values[static_cast<std::size_t>(std::max(0.0, std::ceil(share * size) - 1.0))];
  };
  return {.mean = std::accumulate(values.begin(), values.end(), 0.0) / size,
          .p50 = percentile(0.50),
          .p95 = percentile(0.95),
          .p99 = percentile(0.99),
          .max = values.back()};
}

void StageStatistics::add(std::span<const StageTime> times) {
  for (const StageTime& time : times) {
    Samples& samples = stages_[time.stage];
    samples.wall_ms.push_back(static_cast<float>(time.wall_ms));
    samples.cpu_ms.push_back(static_cast<float>(time.cpu_ms));
  }
}

std::vector<StageStatistics::Row> StageStatistics::rows() const {
  std::vector<Row> rows;
  for (const auto& [stage, samples] : stages_)
    rows.push_back({stage, samples.wall_ms.size(), distribution_of(samples.wall_ms),
                    distribution_of(samples.cpu_ms)});
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return place_in_pipeline(a) < place_in_pipeline(b);
  });
  return rows;
}

TrackingStatistics tracking_statistics(const RunSummary& summary) {
  TrackingStatistics result{.frames = summary.poses.size() + summary.dropped_frames,
                            .processed = summary.poses.size()};
  std::optional<TrackState> last;
  for (const TrackedPose& pose : summary.poses) {
    if (pose.state == TrackState::kTracking) ++result.tracked;
    // Frames that were tracked in a map that was begun anew count as waiting.
    if (pose.state == TrackState::kLost && last && last != TrackState::kLost) ++result.times_lost;
    result.depth_registered += pose.depth_registered ? 1 : 0;
    result.poorly_constrained += pose.poorly_constrained ? 1 : 0;
    last = pose.state;
  }
  return result;
}

double peak_memory_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("VmHWM:")) continue;
    double kib = 0.0;
    std::istringstream(line.substr(6)) >> kib;
    return kib / 1024.0;
  }
  return 0.0;
}

}  // namespace stillpoint
