// tables.tex: the tables of a study for a paper.
#pragma once

#include <string>

#include "study/study_results.hpp"

namespace stillpoint::study {

/// Tables of the package booktabs: the trajectory error, RMSE to S.D. of all errors, the comparison
/// with the baseline, times of the stages. Medians of the repeats; the best of each sequence is
/// bold, † stands behind variants that differ from the baseline, figures of others are in italics.
/// A comment says what made the runs. `title` is part of the labels, tab:TITLE-ate and so on.
std::string latex_report(const StudyResults& results, const std::string& title);

}  // namespace stillpoint::study
