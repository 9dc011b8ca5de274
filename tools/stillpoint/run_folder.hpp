// The folder a run writes into.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "console.hpp"
#include "stillpoint/plugin.hpp"

namespace spdlog {
class logger;
}

namespace stillpoint {

/// Made with its parents; results of an earlier run in it are removed, its dense map only at the
/// end. Holds pipeline.yaml and log.txt from the start.
class RunFolder {
 public:
  /// Throws Error(kUsage) when the folder cannot be written.
  RunFolder(std::filesystem::path path, const std::string& effective_yaml, Console& console);

  const std::filesystem::path& path() const { return path_; }
  /// Into log.txt; warnings and errors also to the console. May be called from any thread.
  void log(LogLevel level, std::string_view text) const;
  /// Of an earlier run, what this one has not replaced. After a run that did not fail.
  void remove_earlier_maps() const;
  /// Names of what is in it, sorted; folders end with '/'.
  std::vector<std::string> contents() const;

 private:
  void remove_earlier_results() const;
  void note_earlier_maps();

  std::filesystem::path path_;
  Console& console_;
  std::shared_ptr<spdlog::logger> log_;
  std::vector<std::pair<std::filesystem::path, std::filesystem::file_time_type>> earlier_maps_;
};

}  // namespace stillpoint
