// What a pipeline file may say, but is seldom meant to.
#pragma once

#include <string>
#include <vector>

#include "stillpoint/engine/pipeline_config.hpp"

namespace stillpoint {

/// A sentence each, for `run` and `check`; those of the configuration included.
std::vector<std::string> warnings_of(const PipelineConfig& config);

}  // namespace stillpoint
