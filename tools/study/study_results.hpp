// All results of a study, as tables ask for them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/cell_result.hpp"
#include "study/matrix.hpp"

namespace stillpoint::study {

/// Of the repeats of a variant on a sequence.
struct Spread {
  double median = 0.0;          ///< of an even number: the mean of the middle two
  double first_quartile = 0.0;  ///< between two values: interpolated, as numpy does
  double third_quartile = 0.0;
  double min = 0.0;
  double max = 0.0;
  std::size_t count = 0;
};
/// Nothing without values.
std::optional<Spread> spread_of(std::vector<double> values);

struct StudyResults {
  const Study& study;
  std::vector<Cell> cells;                         ///< in the order of cells_of()
  std::vector<std::optional<CellResult>> results;  ///< parallel to `cells`; nothing: not run yet
  std::string command;                             ///< that makes them

  /// Of the repeats: the first index, and the one behind the last.
  std::pair<std::size_t, std::size_t> cells_of(std::size_t sequence, std::size_t variant) const;
  std::optional<Spread> spread(std::size_t sequence, std::size_t variant, MetricId metric) const;
  /// Of all runs of the variant.
  std::optional<Spread> spread(std::size_t variant, MetricId metric) const;
  /// Of all runs.
  std::optional<Spread> spread(MetricId metric) const;
  /// Null: not run, or not wanted.
  const CellResult* find(const Cell& cell) const;
  std::size_t failed() const;
  std::size_t missing() const;
  /// Of the repeats, those that have failed, and those that are missing.
  std::pair<std::size_t, std::size_t> without_result(std::size_t sequence,
                                                     std::size_t variant) const;
  /// Whether every repeat has failed.
  bool all_failed(std::size_t sequence, std::size_t variant) const;
};

/// The sequence along the same camera path without anything that moves; nothing without one.
std::optional<std::size_t> empty_scene_of(const Study& study, std::size_t sequence);
/// Whether it is that of another sequence.
bool is_empty_scene(const Study& study, std::size_t sequence);

/// ATE on a sequence ÷ ATE on the sequence without anything that moves, in the same study, with the
/// same variant; medians of the repeats. Nothing without such a sequence.
std::optional<double> dynamic_penalty(const StudyResults& results, std::size_t sequence,
                                      std::size_t variant);

/// Index of the variant that is the baseline; nothing without one.
std::optional<std::size_t> baseline_of(const Study& study);

/// 1 - ATE ÷ ATE of the baseline in per cent, the paper's "improvements" (its equation 7), of each
/// repeat with the baseline's run of the same seed.
std::optional<Spread> improvement_percent(const StudyResults& results, std::size_t sequence,
                                          std::size_t variant);

/// Of each variant, whether it has the best median on a sequence, as evaluation::best_of says. An
/// error is not the best where a larger share of the runs failed, lost tracking or have no error
/// than of another variant.
std::vector<bool> best_variants(const StudyResults& results, std::size_t sequence, MetricId metric);
/// The same for captions, behind "the best".
std::string among_comparable();

}  // namespace stillpoint::study
