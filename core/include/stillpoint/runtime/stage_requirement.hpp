// Requirements on the results of a stage.
#pragma once

#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint {

/// Throws Error(kStage) with what is wrong and what to do, to be named by the caller (in_stage).
inline void require_of_stage(bool right, const std::string& problem, const std::string& remedy) {
  if (!right) throw Error(Fault::kStage, problem, "", remedy);
}

}  // namespace stillpoint
