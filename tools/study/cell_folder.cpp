#include "study/cell_folder.hpp"

#include <sstream>
#include <string>
#include <string_view>

#include "stillpoint/error.hpp"
#include "study/cell_result.hpp"
#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConsole = "console.txt";
constexpr const char* kJobLog = "slurm.txt";
constexpr const char* kResult = "result.json";
constexpr const char* kWritten = "cell_files.txt";
constexpr const char* kWrittenHead =
    "# Files of this run, which the next run of the cell removes: bytes, time, name";

bool has_only(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

/// "result.json.1234-0.part", of a study that was killed while it wrote the file.
bool is_unfinished(const fs::path& file, const char* of) {
  return file.extension() == ".part" && file.stem().stem() == of &&
         has_only(file.stem().extension().string(), ".-0123456789");
}

/// What the study itself writes beside the run.
bool is_note(const fs::path& file) {
  if (file.has_parent_path()) return false;
  return file == kResult || file == kJobLog || file == kWritten || is_unfinished(file, kResult) ||
         is_unfinished(file, kWritten);
}

}  // namespace

void require_own_folder(const fs::path& run) {
  std::error_code none;
  if (!fs::exists(run, none) || fs::is_empty(run, none)) return;
  if (fs::exists(run / kConsole, none) || read_result(run)) return;
  throw Error(Fault::kUsage, "is no run of a study, and would be replaced", run.string(),
              "move it, or choose another folder with -o");
}

fs::path job_log_of(const fs::path& run) { return run / kJobLog; }

CellFolder::CellFolder(fs::path run) : run_(std::move(run)) { require_own_folder(run_); }

fs::path CellFolder::console() const { return run_ / kConsole; }

void CellFolder::forget_result() const {
  std::error_code none;
  if (!fs::exists(run_, none)) return;
  keep_mark();
  remove(kResult);
  remove(kJobLog);
}

// The list goes last: without it, a half-cleaned folder would be nobody's.
void CellFolder::clear() {
  make_folder(run_);
  keep_mark();
  const Files earlier = written();
  for (const auto& [file, version] : files_now()) {
    const auto known = earlier.find(file);
    const bool is_own = known != earlier.end() && known->second == version;
    if (file != kWritten && (is_own || is_note(file))) remove(file);
  }
  remove(kWritten);
  others_ = files_now();
}

void CellFolder::note_written() const {
  std::ostringstream lines;
  for (const auto& [file, version] : files_now()) {
    const auto before = others_.find(file);
    const bool is_other = before != others_.end() && before->second == version;
    if (is_other || file == kConsole || is_note(file)) continue;
    lines << version.first << ' ' << version.second << ' ' << file.generic_string() << '\n';
  }
  if (lines.str().empty()) return;
  write_text(run_ / kWritten, std::string(kWrittenHead) + "\n" + lines.str());
}

void CellFolder::keep_mark() const {
  std::error_code none;
  if (!fs::exists(console(), none)) write_text(console(), "");
}

// Links are not followed: what they lead to is not the run's.
CellFolder::Files CellFolder::files_now() const {
  Files files;
  std::error_code error;
  fs::recursive_directory_iterator entry(run_, fs::directory_options::skip_permission_denied,
                                         error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    if (entry->symlink_status(gone).type() != fs::file_type::regular) continue;
    const auto bytes = entry->file_size(gone);
    const auto time = entry->last_write_time(gone);
    if (!gone)
      files.emplace(entry->path().lexically_relative(run_),
                    Version(bytes, time.time_since_epoch().count()));
  }
  return files;
}

CellFolder::Files CellFolder::written() const {
  Files files;
  std::istringstream list(read_text(run_ / kWritten));
  std::string line;
  if (!std::getline(list, line) || line != kWrittenHead) return files;
  while (std::getline(list, line)) {
    std::istringstream entry(line);
    Version version;
    std::string name;
    if (entry >> version.first >> version.second && entry.get() == ' ' && std::getline(entry, name))
      files.emplace(name, version);
  }
  return files;
}

/// With the folders that become empty.
void CellFolder::remove(const fs::path& file) const {
  remove_folder(run_ / file);
  for (fs::path folder = file.parent_path(); !folder.empty(); folder = folder.parent_path()) {
    std::error_code is_not_empty;
    if (!fs::remove(run_ / folder, is_not_empty)) return;
  }
}

}  // namespace stillpoint::study
