// Which builds made the runs of a study, where and when.
#pragma once

#include <string>
#include <vector>

#include "study/study_results.hpp"

namespace stillpoint::study {

/// One line per build and machine: "Stillpoint 0.1.0, commit 0123456789ab; AMD EPYC, 2 cores;
/// 2026-11-26 to 2026-11-27". Of several, each begins with its share, "6 of 7 runs: ".
std::vector<std::string> provenance(const StudyResults& results);

}  // namespace stillpoint::study
