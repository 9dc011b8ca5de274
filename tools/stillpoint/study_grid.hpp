// Variants of a study that differ in the values of some options.
#pragma once

#include "stillpoint/runtime/config_node.hpp"
#include "stillpoint/runtime/fault_list.hpp"

namespace stillpoint {

/// Puts in place of each variant with `grid: {KEY: [VALUE, …], …}` one variant for every
/// combination of values: KEY=VALUE stands behind its `set`, and LAST_WORD_OF_KEY-VALUE behind its
/// name.
void expand_grids(ConfigNode& study, FaultList& faults);

}  // namespace stillpoint
