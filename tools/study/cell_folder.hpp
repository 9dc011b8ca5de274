// The folder of a cell: a run that is made again replaces the files of the last one, and no others.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

namespace stillpoint::study {

/// Throws Error(kUsage) where there are files and no study has run there.
void require_own_folder(const std::filesystem::path& run);

/// For what the job of a cluster has written that left no result.
std::filesystem::path job_log_of(const std::filesystem::path& run);

/// Whoever uses it holds the lock of the study, or is the job of a cluster that does the cell.
class CellFolder {
 public:
  /// Throws as require_own_folder does.
  explicit CellFolder(std::filesystem::path run);

  /// What the run prints. It also says whose folder this is, and so stays until it is replaced.
  std::filesystem::path console() const;

  /// What is there from now on is the result of a later run. Leaves the rest as it is.
  void forget_result() const;

  /// Makes the folder, and removes what the last run has written and nobody has changed since.
  /// Files of a run that was killed are not known here; `stillpoint run` knows and replaces them.
  /// Throws Error(kUsage) when something cannot be removed.
  void clear();
  /// Notes what has been written since clear(), for the next one. Throws Error(kUsage).
  void note_written() const;

 private:
  using Version = std::pair<std::uintmax_t, std::int64_t>;  // bytes, time in the system's units
  using Files = std::map<std::filesystem::path, Version>;   // paths from the folder

  void keep_mark() const;
  Files files_now() const;
  Files written() const;
  void remove(const std::filesystem::path& file) const;

  std::filesystem::path run_;
  Files others_;  // that clear() has left
};

}  // namespace stillpoint::study
