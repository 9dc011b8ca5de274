// results.csv: one row per cell.
#pragma once

#include <string>

#include "study/study_results.hpp"

namespace stillpoint::study {

/// Columns: sequence, variant, repeat, seed, state (done, failed, missing), exit_code, one per
/// metric, seconds, message. RFC 4180; what is not known is empty.
std::string csv_report(const StudyResults& results);

}  // namespace stillpoint::study
