// Which files of a folder have been written since a moment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

namespace stillpoint {

/// The files in a folder and below it, as they were when this was made. Links are not followed.
class FolderContents {
 public:
  /// A folder that is not there is an empty one.
  explicit FolderContents(std::filesystem::path folder);

  /// Files that are new or changed now, sorted; paths are relative to the folder.
  std::vector<std::filesystem::path> written_since() const;

 private:
  using Version = std::pair<std::filesystem::file_time_type, std::uintmax_t>;  // and size in bytes
  using Files = std::map<std::filesystem::path, Version>;

  Files files_now() const;

  std::filesystem::path folder_;
  Files files_;
};

}  // namespace stillpoint
