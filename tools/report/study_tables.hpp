// The tables of a study: a matrix per figure, and the comparison with the baseline.
#pragma once

#include <vector>

#include "report/report_data.hpp"
#include "study/study_results.hpp"

namespace stillpoint::report {

/// Sequences × variants, medians with (smallest–largest) of the repeats; the best of each row is
/// marked, errors only among variants that cover the same. A dagger stands behind a variant that
/// differs from the baseline (study/paired_comparison.hpp, corrected p < 0.05). Figures that no run
/// has, or that are 0 everywhere, have no table.
std::vector<Table> study_tables(const study::StudyResults& results);

}  // namespace stillpoint::report
