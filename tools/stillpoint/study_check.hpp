// What can be wrong with a study besides its form: names, folders, pipelines, scenes.
#pragma once

#include "stillpoint/engine/registry.hpp"
#include "stillpoint/runtime/config_node.hpp"
#include "stillpoint/runtime/fault_list.hpp"
#include "study/study.hpp"

namespace stillpoint {

/// `tree` is what `study` was read from, `faults` what has been found until then. Throws
/// ConfigError with all faults, those of the pipelines behind those of the study.
void check_study(const ConfigNode& tree, const study::Study& study, Registry& registry,
                 FaultList faults);

}  // namespace stillpoint
