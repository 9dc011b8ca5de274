// A run folder, as `stillpoint run` leaves it.
#pragma once

#include <filesystem>
#include <string>

#include "report/report_data.hpp"

namespace stillpoint::report {

/// Whether something of a run lies there.
bool is_run(const std::filesystem::path& folder);

/// What is missing, incomplete or unreadable becomes a note; nothing is thrown for it. `recording`
/// has the truth; empty: the one that the pipeline names.
RunData read_run(const std::filesystem::path& folder, const std::string& name,
                 std::filesystem::path recording = {});

/// Says in what `run` differs from a pipeline, as YAML; `base` names it.
void compare_options(RunData& run, const std::string& base, const std::string& base_yaml);

}  // namespace stillpoint::report
