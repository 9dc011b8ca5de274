// What is known of a cell that has been run, and the file that keeps it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "study/metrics.hpp"

namespace stillpoint::study {

struct CellResult {
  std::string fingerprint;
  std::string program;    ///< which build of the program and its plugins made it
  int exit_code = 0;      ///< of the run; 128 + signal when one ended it
  std::string message;    ///< why it failed, or why errors are missing
  double seconds = 0.0;   ///< that the run took
  MetricValues values{};  ///< of a run that has ended well

  bool failed() const { return exit_code != 0; }
};

void write_result(const std::filesystem::path& run, const CellResult& result);

/// Nothing when the run has none, or none that can be read.
std::optional<CellResult> read_result(const std::filesystem::path& run);

}  // namespace stillpoint::study
