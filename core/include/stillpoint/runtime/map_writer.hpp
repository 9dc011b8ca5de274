// A sparse map into a file.
#pragma once

#include <filesystem>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint {

/// Replaces what is there; a process that dies meanwhile leaves a part (see save_map). Throws
/// SqliteFault.
void write_map(const SparseMap& map, const std::filesystem::path& file);

}  // namespace stillpoint
