// Figures of a study as cells of tables.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/study_results.hpp"
#include "study/table.hpp"

namespace stillpoint::study {

inline constexpr const char* kNothing = "–";  ///< a cell without a figure

/// "0.0021 (0.0020–0.0022)", "5.0 (-3.0 to 9.0)": median (smallest–largest).
TableCell spread_cell(const std::optional<Spread>& spread, int digits);

/// Decimals of a ratio: so many that one of 0.0034 can be told from none.
int ratio_digits(const Spread& ratio);

/// "0.90 (0.88–0.92)": median (quartiles).
TableCell ratio_cell(const std::optional<Spread>& ratio);

TableCell number_cell(double value, int digits);

/// ", coverage 90.0 %"; empty where all is covered. An error of a part of a recording is none of
/// the whole.
std::string coverage_note(const StudyResults& results, std::size_t sequence, std::size_t variant);

/// "90.0", "40.0–90.0" with a dash: in per cent, of the runs of a variant; empty where all is
/// covered.
std::string partial_coverage(const StudyResults& results, std::size_t sequence, std::size_t variant,
                             const std::string& dash);

/// " [1 of 2]": of so many repeats; empty when all gave the figure.
std::string count_note(const Spread& spread, int repeats);

/// A figure of a variant on a sequence, an error with its coverage: "0.0600, coverage 90.0 % [1 of
/// 2]" where only one of two repeats gave it.
TableCell metric_cell(const StudyResults& results, std::size_t sequence, std::size_t variant,
                      MetricId metric);

/// What others have published of a recording (see original_of), or of a stage.
TableCell published_cell(const Published& system, const std::string& recording, MetricId metric);

/// The systems of which a time has been published of a stage that runs have timed, too.
std::vector<const Published*> published_with_stages_of(const StudyResults& results);

/// "DS-SLAM (published)"
std::string published_name(const Published& system);

/// "Published, not measured here: DS-SLAM (Yu et al., 2018)."; empty without any.
std::string published_note(const std::vector<const Published*>& systems);

}  // namespace stillpoint::study
