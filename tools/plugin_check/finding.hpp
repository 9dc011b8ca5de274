// What a check of a plugin has found.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace stillpoint::plugin_check {

struct Finding {
  std::string what;    ///< what the stage did
  std::string why;     ///< why it matters in a run
  std::string remedy;  ///< what to do
};

/// Ends a case.
class Failure final : public std::runtime_error {
 public:
  explicit Failure(Finding found) : std::runtime_error(found.what), finding(std::move(found)) {}
  Finding finding;
};

/// What the calls of one function took.
struct CallTime {
  std::string function;
  int calls = 0;
  double median_ms = 0;   ///< wall clock
  double slowest_ms = 0;  ///< wall clock
};

/// One case of one type.
struct CaseResult {
  enum class Outcome { kPassed, kFailed, kNotRun } outcome = Outcome::kPassed;
  std::string name;
  Finding finding;     ///< of one that failed; `what` is the reason of one that was not run
  std::string remark;  ///< of one that passed; may be empty
  std::vector<CallTime> times;  ///< of the usual recording only
};

}  // namespace stillpoint::plugin_check
