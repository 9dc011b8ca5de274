#include "stillpoint/engine/install_layout.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

#include "stillpoint/support/model_lookup.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

// Debian's libraries lie in a folder of lib per architecture; a build tree has plain lib.
constexpr std::array kLibraryFolders = {STILLPOINT_LIBRARY_FOLDER, "lib"};

std::vector<fs::path> folders_of_variable(const char* name) {
  std::vector<fs::path> folders;
  const char* value = std::getenv(name);
  std::istringstream stream(value ? value : "");
  for (std::string folder; std::getline(stream, folder, ':');)
    if (!folder.empty()) folders.push_back(fs::absolute(folder).lexically_normal());
  return folders;
}

}  // namespace

fs::path installation_folder() {
  static const char here = 0;  // in the library of the engine
  const fs::path folder = folder_of(&here), above = folder.parent_path();
  const bool per_architecture = folder == above.parent_path() / STILLPOINT_LIBRARY_FOLDER;
  return per_architecture ? above.parent_path() : above;
}

bool installation_has_sdk() {
  return std::ranges::any_of(kLibraryFolders, [](const char* libraries) {
    std::error_code error;
    return fs::exists(installation_folder() / libraries / "cmake/Stillpoint/StillpointConfig.cmake",
                      error);
  });
}

std::vector<fs::path> default_plugin_folders() {
  std::vector<fs::path> folders = folders_of_variable("STILLPOINT_PLUGIN_PATH");
  for (const char* libraries : kLibraryFolders) {
    const fs::path folder = installation_folder() / libraries / "stillpoint/plugins";
    if (std::ranges::find(folders, folder) == folders.end()) folders.push_back(folder);
  }
  return folders;
}

std::vector<fs::path> config_folders() {
  std::vector<fs::path> folders = folders_of_variable("STILLPOINT_CONFIG_PATH");
  folders.push_back(installation_folder() / "share/stillpoint/configs");
  return folders;
}

}  // namespace stillpoint
