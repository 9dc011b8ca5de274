// Why a run has failed, from what it wrote to its console.
#pragma once

#include <filesystem>
#include <string>

#include "study/child_process.hpp"

namespace stillpoint::study {

/// Its error messages in one line, or the signal that ended it, or else the last line it wrote.
std::string failure_text(const std::filesystem::path& console, const ProcessEnd& end);

}  // namespace stillpoint::study
