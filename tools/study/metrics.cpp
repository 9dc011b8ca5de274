#include "study/metrics.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "evaluation/evaluation.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<Metric, kMetricCount> kMetrics = {{
    {"ate_m", "Absolute trajectory error, SE(3), RMSE", "ATE", "m", 4},
    {"sim3_scale", "Scale that Sim(3) alignment finds", "scale", "", 4},
    {"rpe_translation_m", "Relative pose error over 1 s, position, RMSE", "RPE", "m", 4},
    {"rpe_rotation_deg", "Relative pose error over 1 s, rotation, RMSE", "RPE", "deg", 3},
    {"coverage_percent", "Coverage: frames with a pose", "coverage", "%", 1},
    {"times_lost", "Times tracking was lost", "lost", "", 0},
    {"dropped_frames", "Frames dropped to keep the pace", "dropped", "", 0},
    {"frames_per_second", "Speed", "speed", "frames/s", 1},
    {"track_p50_ms", "Tracking thread, CPU per frame, median", "tracking, p50", "ms", 1},
    {"track_p95_ms", "Tracking thread, CPU per frame, 95th percentile", "tracking, p95", "ms", 1},
    {"cpu_ms_per_frame", "Whole process, CPU per frame", "process", "ms", 1},
    {"peak_memory_mib", "Peak memory", "memory", "MiB", 0},
}};

void read_summary(const std::filesystem::path& file, MetricValues& values) {
  try {
    std::ifstream stream(file);
    const Json summary = Json::parse(stream);
    values[kCoverage] = 100.0 * summary.at("coverage").get<double>();
    values[kTimesLost] = summary.at("times_lost").get<double>();
    values[kDroppedFrames] = summary.at("dropped_frames").get<double>();
    if (const double seconds = summary.at("wall_seconds").get<double>(); seconds > 0.0)
      values[kSpeed] = summary.at("processed_frames").get<double>() / seconds;
    values[kCpuPerFrame] = summary.at("cpu_ms_per_frame").get<double>();
    values[kPeakMemory] = summary.at("peak_memory_mib").get<double>();
    const Json& stages = summary.at("stages");
    if (!stages.contains("track_thread")) return;  // no frame was tracked
    const Json& track = stages.at("track_thread").at("cpu_ms");
    values[kTrackP50] = track.at("p50").get<double>();
    values[kTrackP95] = track.at("p95").get<double>();
  } catch (const Json::exception& error) {
    throw Error(Fault::kStage, std::string("is no summary of a run: ") + error.what(),
                file.string(), "the pipeline needs the outputs trajectory and summary");
  }
}

}  // namespace

std::span<const Metric, kMetricCount> metrics() { return kMetrics; }

MetricValues measure_run(const std::filesystem::path& run, const std::filesystem::path& recording,
                         std::string& note) {
  MetricValues values;
  read_summary(run / "summary.json", values);
  try {
    const evaluation::Evaluation result =
        evaluation::evaluate(evaluation::read_trajectory(recording / "groundtruth.txt"),
                             evaluation::read_trajectory(run / "trajectory.txt"), {}, {});
    values[kAte] = result.rigid.metres.rmse;
    values[kScale] = result.similarity.reference_from_estimate.scale;
    if (result.relative) {
      values[kRpeTranslation] = result.relative->translation_m.rmse;
      values[kRpeRotation] = result.relative->rotation_deg.rmse;
    }
  } catch (const Error& error) {
    note = error.what();
  }
  return values;
}

}  // namespace stillpoint::study
