// Results of cases as text, from one process to another and for programs.
#pragma once

#include <nlohmann/json.hpp>

#include "plugin_check/finding.hpp"

namespace stillpoint::plugin_check {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, what, why, remedy)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CallTime, function, calls, median_ms, slowest_ms)
NLOHMANN_JSON_SERIALIZE_ENUM(CaseResult::Outcome, {{CaseResult::Outcome::kPassed, "passed"},
                                                   {CaseResult::Outcome::kFailed, "failed"},
                                                   {CaseResult::Outcome::kNotRun, "not run"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CaseResult, outcome, name, finding, remark, times)

}  // namespace stillpoint::plugin_check
