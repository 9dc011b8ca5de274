#include "study/metrics.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "evaluation/evaluation.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto kAlone = Metric::Group::kAlone;
constexpr auto kStatistics = Metric::Group::kErrorStatistics;
constexpr auto kStages = Metric::Group::kStageTimes;
constexpr auto kLarger = evaluation::Better::kLarger;
constexpr auto kNeither = evaluation::Better::kNeither;

// Each stage has the key of its times in summary.json, followed by "_ms".
constexpr std::array<Metric, kMetricCount> kMetrics = {{
    {"ate_m", "Absolute trajectory error, SE(3), RMSE", "ATE", "m", 4, kAlone, true},
    {"sim3_scale", "Scale of the Sim(3) alignment: the estimate times this fits the truth", "scale",
     "", 4, kAlone, true, kNeither},
    {"rpe_translation_m", "Relative pose error over 1 s, position, RMSE", "RPE", "m", 4, kAlone,
     true},
    {"rpe_rotation_deg", "Relative pose error over 1 s, rotation, RMSE", "RPE", "deg", 3, kAlone,
     true},
    {"coverage_percent", "Coverage: frames with a pose", "coverage", "%", 1, kAlone, false,
     kLarger},
    {"times_lost", "Times tracking was lost", "lost", "", 0},
    {"dropped_frames", "Frames dropped to keep the pace", "dropped", "", 0},
    {"frames_per_second", "Speed", "speed", "frames/s", 1, kAlone, false, kLarger},
    {"track_p50_ms", "Tracking thread, CPU per frame, median", "tracking, p50", "ms", 1},
    {"track_p95_ms", "Tracking thread, CPU per frame, 95th percentile", "tracking, p95", "ms", 1},
    {"cpu_ms_per_frame", "Whole process, CPU per frame", "process", "ms", 1},
    {"peak_memory_mib", "Peak memory", "memory", "MiB", 0},
    {"ate_mean_m", "Absolute trajectory error, mean", "mean", "m", 4, kStatistics, true},
    {"ate_median_m", "Absolute trajectory error, median", "median", "m", 4, kStatistics, true},
    {"ate_sd_m", "Absolute trajectory error, S.D.", "S.D.", "m", 4, kStatistics, true},
    {"rpe_translation_mean_m", "Relative pose error, position, mean", "mean", "m", 4, kStatistics,
     true},
    {"rpe_translation_median_m", "Relative pose error, position, median", "median", "m", 4,
     kStatistics, true},
    {"rpe_translation_sd_m", "Relative pose error, position, S.D.", "S.D.", "m", 4, kStatistics,
     true},
    {"rpe_rotation_mean_deg", "Relative pose error, rotation, mean", "mean", "deg", 3, kStatistics,
     true},
    {"rpe_rotation_median_deg", "Relative pose error, rotation, median", "median", "deg", 3,
     kStatistics, true},
    {"rpe_rotation_sd_deg", "Relative pose error, rotation, S.D.", "S.D.", "deg", 3, kStatistics,
     true},
    {"source_ms", "Reading images", "source", "ms", 2, kStages},
    {"prepare_ms", "Feature extraction", "prepare", "ms", 2, kStages},
    {"moving_check_ms", "Moving check", "moving_check", "ms", 2, kStages},
    {"map_check_ms", "Map check", "map_check", "ms", 2, kStages},
    {"segmentation_wait_ms", "Waiting for labels", "segmentation_wait", "ms", 2, kStages},
    {"segmentation_ms", "Segmentation", "segmentation", "ms", 2, kStages},
    {"propagate_ms", "Propagating labels", "propagate", "ms", 2, kStages},
    {"beside_wait_ms", "Waiting for what runs beside", "beside_wait", "ms", 2, kStages},
    {"decision_ms", "Decision", "decision", "ms", 2, kStages},
    {"track_ms", "Tracking", "track", "ms", 2, kStages},
    {"track_thread_ms", "Tracking thread, whole frame", "track_thread", "ms", 2, kStages},
    {"outputs_ms", "Outputs", "outputs", "ms", 2, kStages},
    {"map_insert_ms", "Inserting key frames", "map_insert", "ms", 2, kStages},
    {"map_refine_ms", "Local bundle adjustment", "map_refine", "ms", 2, kStages},
    {"map_correct_ms", "Correcting the map", "map_correct", "ms", 2, kStages},
    {"loop_ms", "Loop search", "loop", "ms", 2, kStages},
    {"loop_adjust_ms", "Loop adjustment", "loop_adjust", "ms", 2, kStages},
    {"dense_ms", "Dense map", "dense", "ms", 2, kStages},
}};

constexpr std::array<ErrorFigures, 3> kErrorFigures = {{
    {"ATE", kAte, kAteMean, kAteMedian, kAteSd},
    {"RPE, position", kRpeTranslation, kRpeTranslationMean, kRpeTranslationMedian,
     kRpeTranslationSd},
    {"RPE, rotation", kRpeRotation, kRpeRotationMean, kRpeRotationMedian, kRpeRotationSd},
}};

void set_figures(const ErrorFigures& figures, const evaluation::Statistics& statistics,
                 MetricValues& values) {
  values[figures.rmse] = statistics.rmse;
  values[figures.mean] = statistics.mean;
  values[figures.median] = statistics.median;
  values[figures.sd] = statistics.standard_deviation;
}

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
    for (std::size_t stage = kFirstStage; stage < kMetricCount; ++stage)
      if (const char* name = kMetrics[stage].brief; stages.contains(name))
        values[stage] = stages.at(name).at("wall_ms").at("mean").get<double>();
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

std::span<const ErrorFigures, 3> error_figures() { return kErrorFigures; }

MetricValues measure_run(const std::filesystem::path& run, const std::filesystem::path& recording,
                         std::string& note) {
  MetricValues values;
  read_summary(run / "summary.json", values);
  try {
    const evaluation::Evaluation result =
        evaluation::evaluate(evaluation::read_trajectory(recording / "groundtruth.txt"),
                             evaluation::read_trajectory(run / "trajectory.txt"), {}, {});
    set_figures(kErrorFigures[0], result.rigid.metres, values);
    values[kScale] = result.scale;
    if (result.relative) {
      set_figures(kErrorFigures[1], result.relative->translation_m, values);
      set_figures(kErrorFigures[2], result.relative->rotation_deg, values);
    }
  } catch (const Error& error) {
    note = error.what();
  }
  return values;
}

}  // namespace stillpoint::study
