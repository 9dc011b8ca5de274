// What is known of a cell that has been run, and the file that keeps it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "evaluation/origin.hpp"
#include "study/metrics.hpp"

namespace stillpoint::study {

using evaluation::Origin;
using evaluation::Program;

struct CellResult {
  std::string fingerprint;
  std::string program;  ///< fingerprint of the build that made it
  Origin origin{};
  int exit_code = 0;      ///< of the run; 128 + signal when one ended it
  std::string message;    ///< why it failed, or why errors are missing
  double seconds = 0.0;   ///< that the run took
  MetricValues values{};  ///< of a run that has ended well

  bool failed() const { return exit_code != 0; }
};

void write_result(const std::filesystem::path& run, const CellResult& result);

/// Nothing when the run has none, or none that can be read.
std::optional<CellResult> read_result(const std::filesystem::path& run);

/// Whether another version of this program has written a result there, which read_result() does not
/// know.
bool has_foreign_result(const std::filesystem::path& run);

}  // namespace stillpoint::study
