#include "written_files.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestList = 16 << 20;  // bytes
constexpr const char* kHead =
    "# Files of this run, which the next one into this folder removes: bytes, time, name";

/// Bytes, and the time in the units of the system's files.
using Version = std::pair<std::uintmax_t, std::int64_t>;

std::optional<Version> version_of(const fs::path& file) {
  std::error_code error;
  if (fs::symlink_status(file, error).type() != fs::file_type::regular) return std::nullopt;
  const auto written = fs::last_write_time(file, error);
  const auto bytes = fs::file_size(file, error);
  if (error) return std::nullopt;
  return Version(bytes, written.time_since_epoch().count());
}

std::string text_of_list(const fs::path& run) {
  try {
    return read_input_file(run / kWrittenFiles, kLargestList);
  } catch (const Error&) {  // there is none, or no file
    return {};
  }
}

}  // namespace

void list_written(const fs::path& run, const std::vector<fs::path>& files) {
  std::ostringstream lines;
  for (const fs::path& file : files)
    if (const auto version = version_of(run / file))
      lines << version->first << ' ' << version->second << ' ' << file.generic_string() << '\n';
  if (lines.str().empty()) return;
  AtomicFile list(run / kWrittenFiles);
  list.stream() << kHead << '\n' << lines.str();
  list.commit();
}

bool is_list_of_a_run(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return false;
  std::ifstream list(file);
  std::string head;
  return std::getline(list, head) && head == kHead;
}

bool lies_in_run(const fs::path& file, const fs::path& run) {
  if (!version_of(file)) return false;
  std::error_code error, other;
  const fs::path folder = fs::canonical(file.parent_path(), error);
  const fs::path way = folder.lexically_relative(fs::canonical(run, other));
  return !error && !other && !way.empty() && *way.begin() != "..";
}

std::vector<fs::path> listed_in(const fs::path& run) {
  std::istringstream list(text_of_list(run));
  std::string line;
  if (!std::getline(list, line) || line != kHead) return {};
  std::vector<fs::path> files;
  while (std::getline(list, line)) {
    std::istringstream entry(line);
    Version written;
    std::string name;
    if (!(entry >> written.first >> written.second) || entry.get() != ' ' ||
        !std::getline(entry, name))
      continue;
    const fs::path file = run / name;
    if (version_of(file) == written && lies_in_run(file, run)) files.push_back(file);
  }
  return files;
}

}  // namespace stillpoint
