// The tables of the DS-SLAM paper: stages, and statistics of the errors.
#pragma once

#include "study/study_results.hpp"
#include "study/table.hpp"

namespace stillpoint::study {

/// The form of Table IV, of all sequences together. Empty without times.
Table stage_table(const StudyResults& results);

/// The form of Tables I to III: a system a row, one named by its sequence and itself.
Table error_statistics_table(const StudyResults& results);

}  // namespace stillpoint::study
