// Everything that a study has found out, as tables.
#pragma once

#include <vector>

#include "study/study_results.hpp"
#include "study/table.hpp"

namespace stillpoint::study {

/// Of a study with one sequence, all figures of a variant in a row. Then sequences × variants of
/// the trajectory error († behind a variant that differs from the baseline, see PairedComparison),
/// the comparison with the baseline, the improvement, the dynamic penalty, a matrix of each other
/// figure, the stages, the statistics of the errors, and what the variants are. What others have
/// published stands in columns of its own. A figure that is 0 in every run has a note and no rows.
std::vector<Table> study_tables(const StudyResults& results);

}  // namespace stillpoint::study
