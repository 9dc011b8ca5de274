// frames.csv and timings.csv of a run folder.
#pragma once

#include <filesystem>
#include <vector>

#include "report/report_data.hpp"

namespace stillpoint::report {

/// Rows of frames.csv; `seconds` are not known yet. Empty when there is no such file.
/// Throws Error(kData) with file and line for what is no such table.
std::vector<FrameRow> read_frames(const std::filesystem::path& file);

/// Of timings.csv, in the order of the pipeline. Empty and errors as above.
std::vector<StageTimes> read_stage_times(const std::filesystem::path& file);

}  // namespace stillpoint::report
