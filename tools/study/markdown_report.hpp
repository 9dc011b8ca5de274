// results.md: the tables of a study.
#pragma once

#include <string>

#include "study/study_results.hpp"

namespace stillpoint::study {

/// A table per metric, sequences × variants and what others have published: medians with
/// (smallest–largest) of the repeats; behind an error the coverage where it is not complete, and
/// how many of the repeats gave the figure when not all did. Then the stages and the statistics of
/// the errors in a table each, what the variants are, and the runs that failed. `title` heads it.
std::string markdown_report(const StudyResults& results, const std::string& title);

}  // namespace stillpoint::study
