// Where a network's files are found.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Folders of models: those of STILLPOINT_MODEL_PATH (separated by colons), `models` beside the
/// library that holds `own_code` (any function or constant of the plugin), and
/// ~/.local/share/stillpoint/models (XDG_DATA_HOME).
STILLPOINT_EXPORT std::vector<std::filesystem::path> model_folders(const void* own_code);

/// The folder of the library or program that holds `code`, any function or constant of it; empty
/// when the system does not tell.
STILLPOINT_EXPORT std::filesystem::path folder_of(const void* code);

/// The file itself, else the file of that name in the first of the model folders that has one.
/// Throws Error(kUsage) that names all places.
STILLPOINT_EXPORT std::filesystem::path find_model(const std::string& file, const void* own_code);

}  // namespace stillpoint
