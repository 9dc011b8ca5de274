// A run folder, as `stillpoint run` leaves it.
#pragma once

#include <filesystem>
#include <string>

#include "report/report_data.hpp"

namespace stillpoint::report {

/// Whether something of a run lies there.
bool is_run(const std::filesystem::path& folder);

/// Where a run's recording and true trajectory lie.
struct RunInputs {
  std::filesystem::path dataset;  ///< empty: what the pipeline names
  std::filesystem::path truth;    ///< empty: groundtruth.txt of the recording
};

/// What is missing, incomplete or unreadable becomes a note; nothing is thrown for it.
RunData read_run(const std::filesystem::path& folder, const std::string& name,
                 const RunInputs& inputs = {});

/// Says in what `run` differs from a pipeline, as YAML; `base` names it.
void compare_options(RunData& run, const std::string& base, const std::string& base_yaml);

}  // namespace stillpoint::report
