// The folder a run writes into.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "console.hpp"
#include "stillpoint/engine/folder_lock.hpp"
#include "stillpoint/plugin.hpp"

namespace spdlog {
class logger;
}

namespace stillpoint {

/// Made with its parents, and nobody else's until the end of the process. Results of an earlier run
/// stay as they are until begin().
class RunFolder {
 public:
  /// `effective_yaml` is to be its pipeline.yaml. Throws Error(kUsage) when the folder cannot be
  /// written, another run is writing into it, or it holds files with the names of results that are
  /// not those of a run.
  RunFolder(std::filesystem::path path, std::string effective_yaml, Console& console);
  /// Leaves no empty folder of its own behind where no run began.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Whether an earlier run has left its log.
  bool holds_earlier_run() const { return holds_earlier_run_; }
  /// Once a frame is through, and so all that the run needs is good: begins the log, removes
  /// results of an earlier run and writes pipeline.yaml. Throws Error when that is not possible.
  void begin();
  bool has_begun() const { return begun_; }
  /// Notes what the run has written, for the next one: what the dense map was saved as, below the
  /// folder `map`, and what the outputs have named. Throws Error when that cannot be written.
  void list_results(const std::vector<std::filesystem::path>& files_of_map) const;
  /// Throws Error(kUsage) when begin() would remove this file, which the run reads.
  void require_no_input_in_the_way(const std::filesystem::path& input) const;
  /// Throws Error(kUsage) when the sparse map would replace another result of the run.
  void require_no_result_in_place_of(const std::filesystem::path& map) const;

  const std::filesystem::path& path() const { return path_; }
  /// Into log.txt; warnings and errors also to the console. May be called from any thread.
  void log(LogLevel level, std::string_view text) const;
  /// Names of what is in it, sorted; folders end with '/'.
  std::vector<std::string> contents() const;

 private:
  void require_none_of(const std::vector<std::filesystem::path>& files) const;
  void add_earlier(const std::vector<std::filesystem::path>& files);
  void require_replaceable() const;
  void begin_log();
  void remove_earlier_files() const;
  void remove_empty_folders(std::filesystem::path folder) const;

  std::filesystem::path path_;
  std::string effective_yaml_;
  Console& console_;
  bool made_ = false;  // by this run
  bool holds_earlier_run_ = false;
  std::atomic<bool> begun_ = false;
  std::atomic<bool> removed_ = false;  // all results of the earlier run
  std::optional<FolderLock> lock_;
  mutable std::mutex mutex_;
  std::shared_ptr<spdlog::logger> log_;                          // guarded, like early_
  mutable std::vector<std::pair<LogLevel, std::string>> early_;  // lines before begin()
  std::vector<std::filesystem::path> named_files_;  // by outputs, as paths from the folder
  // Of earlier runs, and when they were written.
  std::vector<std::pair<std::filesystem::path, std::filesystem::file_time_type>> earlier_files_;
};

}  // namespace stillpoint
