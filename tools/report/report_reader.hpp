// Everything a report shows, from folders of runs or of a study.
#pragma once

#include <filesystem>
#include <vector>

#include "report/report_data.hpp"
#include "study/study.hpp"

namespace stillpoint::report {

/// Of one or more run folders; the caller adds the command. `truth` is the true trajectory of all;
/// empty: each recording's own. Throws Error(kUsage) for a folder that holds no run.
ReportData read_runs(const std::vector<std::filesystem::path>& folders,
                     const std::filesystem::path& truth = {});

/// Of a study's folder, whose runs may be missing, unfinished or made by another version: notes say
/// so. Every run that has left something is in it; the pipeline of each is compared with that of
/// the baseline, or of the first variant.
ReportData read_study(const std::filesystem::path& folder, const study::Study& study);

}  // namespace stillpoint::report
