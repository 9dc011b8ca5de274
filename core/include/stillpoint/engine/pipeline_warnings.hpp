// What a pipeline file may say, but is seldom meant to.
#pragma once

#include <string>
#include <vector>

#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// A sentence each; those of the configuration included.
STILLPOINT_EXPORT std::vector<std::string> warnings_of(const PipelineConfig& config);

}  // namespace stillpoint
