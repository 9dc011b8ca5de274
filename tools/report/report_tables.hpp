// The tables of a study, as a page shows them.
#pragma once

#include <vector>

#include "study/study_results.hpp"
#include "study/table.hpp"

namespace stillpoint::report {

/// Those of study::study_tables() that have rows; their notes also say what is bold.
std::vector<study::Table> report_tables(const study::StudyResults& results);

}  // namespace stillpoint::report
