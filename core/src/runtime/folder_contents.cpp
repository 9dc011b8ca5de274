#include "stillpoint/runtime/folder_contents.hpp"

#include <system_error>

namespace stillpoint {

namespace fs = std::filesystem;

FolderContents::FolderContents(fs::path folder) : folder_(std::move(folder)), files_(files_now()) {}

std::vector<fs::path> FolderContents::written_since() const {
  std::vector<fs::path> written;
  for (const auto& [file, version] : files_now()) {
    const auto before = files_.find(file);
    if (before == files_.end() || before->second != version) written.push_back(file);
  }
  return written;
}

FolderContents::Files FolderContents::files_now() const {
  Files files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder_, fs::directory_options::skip_permission_denied,
                                         error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    if (entry->symlink_status(gone).type() != fs::file_type::regular) continue;
    const Version version{entry->last_write_time(gone), entry->file_size(gone)};
    if (!gone) files.emplace(entry->path().lexically_relative(folder_), version);
  }
  return files;
}

}  // namespace stillpoint
