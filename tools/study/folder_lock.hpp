// Keeps two studies out of one folder.
#pragma once

#include <filesystem>

namespace stillpoint::study {

/// Held until the end of its scope, or of the process.
class FolderLock {
 public:
  /// Throws Error(kUsage) when another process holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace stillpoint::study
