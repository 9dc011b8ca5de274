// The one exception of the project: what went wrong, where, and what to do about it.
#pragma once

#include <stdexcept>
#include <string>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Who has to act. The values are the exit codes of the program.
enum class Fault {
  kStage = 1,  ///< a stage failed while running
  kUsage = 2,  ///< command line, configuration, plugins
  kData = 3,   ///< recording, image, model or map file
};

/// Faults of set-up and I/O. Expected outcomes (lost, no loop, too few points) are values instead.
/// `what()` reads "where: problem; remedy", with empty parts left out.
class STILLPOINT_EXPORT Error : public std::runtime_error {
 public:
  Error(Fault fault, const std::string& problem, const std::string& where = {},
        const std::string& remedy = {});
  ~Error() override;

  Fault fault() const { return fault_; }
  int exit_code() const { return static_cast<int>(fault_); }

 private:
  Fault fault_;
};

}  // namespace stillpoint
