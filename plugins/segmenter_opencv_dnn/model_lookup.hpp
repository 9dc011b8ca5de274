// Where a network's files are found.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stillpoint {

/// Folders of models: those of STILLPOINT_MODEL_PATH (separated by colons), `models` beside this
/// plugin, and ~/.local/share/stillpoint/models (XDG_DATA_HOME).
std::vector<std::filesystem::path> model_folders();

/// The file itself, else the file of that name in the first of the model folders that has one.
/// Throws Error(kUsage) that names all places.
std::filesystem::path find_model(const std::string& file);

}  // namespace stillpoint
