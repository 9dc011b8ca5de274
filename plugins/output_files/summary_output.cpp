#include "output_files/summary_output.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>

#include "stillpoint/support/atomic_file.hpp"

namespace stillpoint::output_files {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Distribution& d) {
  return {{"mean", d.mean}, {"p50", d.p50}, {"p95", d.p95}, {"p99", d.p99}, {"max", d.max}};
}

Json stages_of(const StageStatistics& statistics) {
  Json stages = Json::object();
  for (const StageStatistics::Row& row : statistics.rows())
    stages[row.stage] = {
        {"count", row.count}, {"wall_ms", to_json(row.wall)}, {"cpu_ms", to_json(row.cpu)}};
  return stages;
}

Json versions() {
  return {{"stillpoint", STILLPOINT_VERSION},
          {"opencv", CV_VERSION},
          {"eigen", STILLPOINT_TEXT(EIGEN_WORLD_VERSION) "." STILLPOINT_TEXT(
                        EIGEN_MAJOR_VERSION) "." STILLPOINT_TEXT(EIGEN_MINOR_VERSION)},
          {"ceres", STILLPOINT_CERES_VERSION},
          {"abi", kAbiTag}};
}

}  // namespace

void SummaryOutput::finish(const RunSummary& summary) {
  statistics_.add(summary.times);
  const TrackingStatistics tracking = tracking_statistics(summary);
  const double processed = static_cast<double>(std::max<std::size_t>(tracking.processed, 1));
  const Json json = {
      {"complete", summary.complete},
      {"failure", summary.failure.empty() ? Json() : Json(summary.failure)},
      {"mode", summary.mode},
      {"seed", summary.seed},
      {"frames", tracking.frames},
      {"processed_frames", tracking.processed},
      {"tracked_frames", tracking.tracked},
      {"dropped_frames", summary.dropped_frames},
      {"dropped_reports", summary.dropped_reports},
      {"loops_closed", summary.loops_closed},
      {"skipped_images", summary.source.skipped},
      {"unlabelled_frames", summary.unlabelled_frames},
      {"segmentation_failures", summary.segmentation_failures},
      {"segmentation_failure",
       summary.segmentation_failures > 0 ? Json(summary.segmentation_failure) : Json()},
      {"coverage", tracking.coverage()},
      {"times_lost", tracking.times_lost},
      {"depth_registered_frames", tracking.depth_registered},
      {"poorly_constrained_frames", tracking.poorly_constrained},
      {"keyframes", summary.map.keyframe_count()},
      {"landmarks", summary.map.landmark_count()},
      {"wall_seconds", summary.wall_seconds},
      {"cpu_seconds", summary.cpu_seconds},
      {"recorded_seconds", summary.recorded_seconds},
      {"cpu_ms_per_frame", 1e3 * summary.cpu_seconds / processed},
      {"peak_memory_mib", peak_memory_mib()},
      {"warnings", summary.source.warnings},
      {"stages", stages_of(statistics_)},
      {"versions", versions()}};
  AtomicFile file(path_);
  // Text from elsewhere may not be valid UTF-8.
  file.stream() << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.commit();
}

}  // namespace stillpoint::output_files
