// Where the program finds its plugins and configurations: relative to the executable, so that an
// installation can be moved. A build tree has the same layout.
#pragma once

#include <filesystem>
#include <vector>

namespace stillpoint {

/// STILLPOINT_PLUGIN_PATH, then the installation's plugin folders.
std::vector<std::filesystem::path> default_plugin_folders();

/// STILLPOINT_CONFIG_PATH, then the installation's share/stillpoint/configs.
std::vector<std::filesystem::path> config_folders();

}  // namespace stillpoint
