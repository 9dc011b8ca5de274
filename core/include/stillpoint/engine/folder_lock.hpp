// Keeps two runs or studies out of one folder.
#pragma once

#include <filesystem>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Held until the end of its scope, or of the process however it ends. Leaves no file behind.
class STILLPOINT_EXPORT FolderLock {
 public:
  /// Throws Error(kUsage) when another process holds it or the folder cannot be read.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace stillpoint
