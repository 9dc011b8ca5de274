// Each variant against the baseline of its study, recording by recording.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/study_results.hpp"

namespace stillpoint::study {

inline constexpr double kSignificance = 0.05;  ///< of a corrected p

/// A pair is a recording, or a scene. Empty scenes are there for the dynamic penalty, and take no
/// part. Repeats are no pairs of their own, new noise or not, and neither are sequences that have
/// the same images and differ in the camera that the pipeline assumes: they are no independent
/// samples of what the test speaks of. The median of their logarithms counts.
///
/// Errors are compared only between runs that have covered the same. Of two runs, the one that
/// failed, or covers less by more than 1 % of the frames, or lost tracking where the other did not,
/// is the worse one, by more than any error.
struct PairedComparison {
  std::size_t variant = 0;     ///< index into the study's
  std::size_t recordings = 0;  ///< on which one of the two has an error
  std::size_t better = 0;      ///< recordings of these on which the variant is better
  std::size_t worse = 0;
  std::size_t incomplete = 0;        ///< recordings of these decided by loss or coverage
  std::optional<Spread> ate_ratio;   ///< to the baseline's, of the other recordings
  std::optional<Spread> time_ratio;  ///< of CPU per frame
  double effect = 0.0;               ///< see SignedRank; positive: better than the baseline
  double p = 1.0;                    ///< of Wilcoxon's test on logarithms of the ratios
  double corrected_p = 1.0;          ///< for the number of variants
  double least_p = 1.0;              ///< the smallest corrected p that so many recordings can give

  bool can_be_significant() const { return least_p < kSignificance; }
  bool is_significant() const { return corrected_p < kSignificance; }
};

/// Of every variant but the baseline that shares a recording with it. Empty without a baseline.
std::vector<PairedComparison> compare_with_baseline(const StudyResults& results);

/// What † says behind a variant, where one is significant; else empty.
std::string significance_note(const Study& study, const std::vector<PairedComparison>& comparisons);

/// That empty scenes take no part, where there are any; else empty.
std::string left_out_note(const Study& study);

/// What least_p says and how many recordings it takes, where one cannot be significant; else empty.
std::string recordings_note(const std::vector<PairedComparison>& comparisons);

}  // namespace stillpoint::study
