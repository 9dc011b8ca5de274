// Where plugins and configurations are found: relative to the library of the engine, so that an
// installation can be moved. A build tree has the same layout.
#pragma once

#include <filesystem>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// The folder that holds bin, lib and share.
STILLPOINT_EXPORT std::filesystem::path installation_folder();

/// Whether find_package(Stillpoint) finds the SDK there: in an installation, not in a build tree.
STILLPOINT_EXPORT bool installation_has_sdk();

/// STILLPOINT_PLUGIN_PATH, then the installation's plugin folders.
STILLPOINT_EXPORT std::vector<std::filesystem::path> default_plugin_folders();

/// STILLPOINT_CONFIG_PATH, then the installation's share/stillpoint/configs.
STILLPOINT_EXPORT std::vector<std::filesystem::path> config_folders();

}  // namespace stillpoint
