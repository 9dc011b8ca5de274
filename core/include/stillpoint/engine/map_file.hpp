// Sparse maps kept in a file: SQLite, one file, with a version.
#pragma once

#include <filesystem>

#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Writes the map to `file` and replaces an existing file atomically: if the process dies, the file
/// is the earlier or the new one. Throws Error(kUsage) when it cannot be written, the path is no
/// regular file, or the map has values that load_map() refuses; what is there then stays.
STILLPOINT_EXPORT void save_map(const SparseMap& map, const std::filesystem::path& file);

/// Throws what save_map would throw, before anything is computed.
STILLPOINT_EXPORT void require_writable(const std::filesystem::path& file);

/// The map of a file; ids are counted anew, without gaps. Throws Error(kData) for a file that is
/// not there, truncated, damaged, of another kind or of a newer version. Never changes the file.
STILLPOINT_EXPORT SparseMap load_map(const std::filesystem::path& file);

}  // namespace stillpoint
