#include "stillpoint/support/bag_files.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCompressed = ".zstd";

// While it is recorded, and when that was interrupted, a bag of ROS 1 is a .bag.active. One that is
// compressed as a whole cannot be read, and whoever opens it says what to do.
bool named_as_bag(const fs::path& file) {
  const std::string name = file.filename().string();
  return std::ranges::any_of(std::initializer_list<const char*>{".bag", ".bag.active", ".mcap",
                                                                ".db3", ".mcap.zstd", ".db3.zstd"},
                             [&](const char* ending) { return name.ends_with(ending); });
}

/// Whether the file lies beside it that this one was compressed from, or decompressed into.
bool is_there_decompressed(const fs::path& file) {
  std::string name = file.string();
  if (!name.ends_with(kCompressed)) return false;
  name.resize(name.size() - kCompressed.size());
  std::error_code error;
  return fs::is_regular_file(name, error);
}

/// Recorders number their files: run_9.db3 comes before run_10.db3.
bool recorded_before(const fs::path& a, const fs::path& b) {
  const std::string left = a.string();
  const std::string right = b.string();
  return left.size() != right.size() ? left.size() < right.size() : left < right;
}

}  // namespace

fs::path bag_path(const fs::path& path) {
  if (path.filename() != "metadata.yaml") return path;
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::vector<fs::path> bag_files(const fs::path& named) {
  const fs::path path = bag_path(named);
  std::error_code error;
  if (!fs::is_directory(path, error))
    return named_as_bag(path) ? std::vector{path} : std::vector<fs::path>{};
  if (fs::exists(path / "rgb.txt", error)) return {};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
    if (entry.is_regular_file(error) && named_as_bag(entry.path()) &&
        !is_there_decompressed(entry.path()))
      files.push_back(entry.path());
  std::ranges::sort(files, recorded_before);
  return files;
}

}  // namespace stillpoint
