// From a checked pipeline file to the stages of a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/engine/stages.hpp"

namespace stillpoint {

/// Makes every stage of `config`. `output_directory` must exist; empty: no outputs, and the dense
/// map is not saved. Throws Error when a stage cannot be made.
STILLPOINT_EXPORT Stages make_stages(const PipelineConfig& config,
                                     const std::filesystem::path& output_directory,
                                     const std::function<void(LogLevel, std::string_view)>& log);

/// A seed for one stage alone, so that adding or changing another stage changes nothing for it.
STILLPOINT_EXPORT std::uint64_t stage_seed(int run_seed, std::string_view section);

}  // namespace stillpoint
