// Every figure of a report as files for a paper.
#pragma once

#include <cstddef>
#include <filesystem>

#include "report/report_data.hpp"

namespace stillpoint::report {

/// As SVG and PDF: in `folder`/RECORDING, the runs on a recording beside each other, at most six of
/// them; in `folder`/RECORDING/RUN, those of a run. Of the repeats of a study's variant the first
/// one counts, as on the page; `folder`/stage_times has the mean CPU time of all runs of each
/// variant. Figures without data are left out. Returns how many there are.
/// Throws Error when a file cannot be written.
std::size_t write_figures(const ReportData& data, const std::filesystem::path& folder);

}  // namespace stillpoint::report
