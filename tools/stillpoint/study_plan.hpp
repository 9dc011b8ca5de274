// What each cell of a study has to do.
#pragma once

#include <filesystem>
#include <vector>

#include "stillpoint/engine/registry.hpp"
#include "study/cell_runner.hpp"
#include "study/study.hpp"

namespace stillpoint {

/// Of `cells` in the order of cells_of(), whose scenes have been recorded below `output`. Throws
/// what load_pipeline() throws, and Error(kData) for a recording that cannot be read.
std::vector<study::PlannedCell> plan_cells(const study::Study& study,
                                           const std::vector<study::Cell>& cells,
                                           const std::filesystem::path& output, Registry& registry);

/// This program and the libraries of its plugins.
std::vector<std::filesystem::path> files_of_program(const Registry& registry);

}  // namespace stillpoint
