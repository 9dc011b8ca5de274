// A folder for files that nobody needs for long.
#pragma once

#include <filesystem>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Below $TMPDIR or /tmp, under a name that is nobody else's; removed with all that is in it.
class STILLPOINT_EXPORT TemporaryFolder {
 public:
  /// Throws Error(kUsage) when it cannot be made.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace stillpoint
