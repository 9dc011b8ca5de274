// The table of single runs.
#pragma once

#include <span>

#include "report/report_data.hpp"

namespace stillpoint::report {

/// A run per row: errors, coverage, speed, memory. The best of a column is marked among runs of one
/// recording, errors only among those that cover as much of it as the one that covers most.
study::Table run_table(std::span<const RunData> runs);

}  // namespace stillpoint::report
