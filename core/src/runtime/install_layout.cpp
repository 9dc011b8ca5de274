#include "stillpoint/engine/install_layout.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "stillpoint/support/model_lookup.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

// The library with this code lies in lib, on Debian in a folder of lib per architecture.
fs::path installation() {
  static const char here = 0;
  const fs::path folder = folder_of(&here), above = folder.parent_path();
  const bool per_architecture = folder == above.parent_path() / STILLPOINT_LIBRARY_FOLDER;
  return per_architecture ? above.parent_path() : above;
}

std::vector<fs::path> folders_of_variable(const char* name) {
  std::vector<fs::path> folders;
  const char* value = std::getenv(name);
  std::istringstream stream(value ? value : "");
  for (std::string folder; std::getline(stream, folder, ':');)
    if (!folder.empty()) folders.push_back(fs::absolute(folder).lexically_normal());
  return folders;
}

}  // namespace

std::vector<fs::path> default_plugin_folders() {
  std::vector<fs::path> folders = folders_of_variable("STILLPOINT_PLUGIN_PATH");
  // Debian's libraries lie in a folder per architecture; a build tree has plain lib.
  for (const char* libraries : {STILLPOINT_LIBRARY_FOLDER, "lib"}) {
    const fs::path folder = installation() / libraries / "stillpoint/plugins";
    if (std::ranges::find(folders, folder) == folders.end()) folders.push_back(folder);
  }
  return folders;
}

std::vector<fs::path> config_folders() {
  std::vector<fs::path> folders = folders_of_variable("STILLPOINT_CONFIG_PATH");
  folders.push_back(installation() / "share/stillpoint/configs");
  return folders;
}

}  // namespace stillpoint
