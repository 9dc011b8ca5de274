// results.csv: one row per cell. summary.csv: one per sequence, variant and figure.
#pragma once

#include <string>

#include "study/study_results.hpp"

namespace stillpoint::study {

/// Columns: sequence, variant, repeat, seed, state (done, failed, missing), exit_code, one per
/// metric, seconds, version, commit, machine, date, message. RFC 4180; what is not known is empty.
std::string csv_report(const StudyResults& results);

/// Columns: sequence, variant, metric, runs (with that figure), failed, missing, median,
/// first_quartile, third_quartile, smallest, largest, study_origin (of all runs: the command, which
/// builds made them, where and when). Without rows in which no run has the figure.
std::string csv_summary(const StudyResults& results);

}  // namespace stillpoint::study
