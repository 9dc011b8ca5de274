// results.md: the tables of a study.
#pragma once

#include <string>

#include "study/study_results.hpp"

namespace stillpoint::study {

/// What made the runs, the tables of study_tables(), and the runs that failed. `title` heads it.
std::string markdown_report(const StudyResults& results, const std::string& title);

}  // namespace stillpoint::study
