// Files that may be named by the folder which holds them.
#pragma once

#include <filesystem>

namespace stillpoint {

/// A folder stands for the file of that name in it.
inline std::filesystem::path in_folder(const std::filesystem::path& path, const char* file) {
  return std::filesystem::is_directory(path) ? path / file : path;
}

}  // namespace stillpoint
