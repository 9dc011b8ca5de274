// Paths that may be those of a folder or of the file in it.
#pragma once

#include <filesystem>
#include <string>

namespace stillpoint {

/// A folder stands for the file of that name in it.
inline std::filesystem::path in_folder(const std::filesystem::path& path, const char* file) {
  std::error_code unreadable;
  return std::filesystem::is_directory(path, unreadable) ? path / file : path;
}

/// What a run is called: its folder, or its file without the ending.
inline std::string name_of_run(const std::filesystem::path& path) {
  const std::filesystem::path clean = path.lexically_normal();
  std::error_code unreadable;
  if (!std::filesystem::is_directory(clean, unreadable)) return clean.stem().string();
  return (clean.has_filename() ? clean.filename() : clean.parent_path().filename()).string();
}

}  // namespace stillpoint
