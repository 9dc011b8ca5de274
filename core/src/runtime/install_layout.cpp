#include "stillpoint/runtime/install_layout.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

fs::path installation() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
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
