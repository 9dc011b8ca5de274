#include "stillpoint/support/bag_files.hpp"

#include <algorithm>
#include <string>
#include <system_error>

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

bool named_as_bag(const fs::path& file) {
  const std::string name = file.filename().string();
  // While it is recorded, and when that was interrupted, a bag of ROS 1 is a .bag.active.
  return std::ranges::any_of(
      std::initializer_list<const char*>{".bag", ".bag.active", ".mcap", ".db3"},
      [&](const char* ending) { return name.ends_with(ending); });
}

/// Recorders number their files: run_9.db3 comes before run_10.db3.
bool recorded_before(const fs::path& a, const fs::path& b) {
  const std::string left = a.string();
  const std::string right = b.string();
  return left.size() != right.size() ? left.size() < right.size() : left < right;
}

}  // namespace

std::vector<fs::path> bag_files(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error))
    return named_as_bag(path) ? std::vector{path} : std::vector<fs::path>{};
  if (fs::exists(path / "rgb.txt", error)) return {};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
    if (entry.is_regular_file(error) && named_as_bag(entry.path())) files.push_back(entry.path());
  std::ranges::sort(files, recorded_before);
  return files;
}

}  // namespace stillpoint
