// What is measured of every run.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "evaluation/best.hpp"

namespace stillpoint::study {

enum MetricId : std::size_t {
  kAte,
  kScale,
  kRpeTranslation,
  kRpeRotation,
  kCoverage,
  kTimesLost,
  kDroppedFrames,
  kSpeed,
  kTrackP50,
  kTrackP95,
  kCpuPerFrame,
  kPeakMemory,
  kAteMean,
  kAteMedian,
  kAteSd,
  kRpeTranslationMean,
  kRpeTranslationMedian,
  kRpeTranslationSd,
  kRpeRotationMean,
  kRpeRotationMedian,
  kRpeRotationSd,
  kFirstStage,  ///< mean wall time of a call of each stage that the pipeline times
  kMetricCount = kFirstStage + 18,
};

struct Metric {
  /// The table of results.md that shows it: one of its own, or one with others of its group.
  enum class Group { kAlone, kErrorStatistics, kStageTimes };

  const char* key;    ///< in results.csv and result.json
  const char* title;  ///< of the table
  const char* brief;  ///< of a column
  const char* unit;   ///< may be empty
  int digits;         ///< behind the decimal point, in tables
  Group group = Group::kAlone;
  bool is_pose_error = false;  ///< means little without the coverage
  evaluation::Better better = evaluation::Better::kSmaller;
};

std::span<const Metric, kMetricCount> metrics();

/// The figures by which an error is summed up, as in Tables I to III of the DS-SLAM paper.
struct ErrorFigures {
  const char* brief;  ///< "ATE"
  MetricId rmse, mean, median, sd;

  std::array<MetricId, 4> all() const { return {rmse, mean, median, sd}; }
};
std::span<const ErrorFigures, 3> error_figures();

/// Nothing where a run gave no such figure, as the RPE over 1 s of a shorter recording.
using MetricValues = std::array<std::optional<double>, kMetricCount>;

/// Of a run that has ended well. When its trajectory cannot be compared, because tracking never
/// began for instance, the errors stay empty and `note` says why. Throws Error when the run has
/// left no summary.json.
MetricValues measure_run(const std::filesystem::path& run, const std::filesystem::path& recording,
                         std::string& note);

}  // namespace stillpoint::study
