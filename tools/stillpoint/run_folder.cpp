#include "run_folder.hpp"

#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "run_results.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "written_files.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

/// "out" of "out/": a folder has one name.
fs::path without_slash(fs::path folder) {
  while (!folder.has_filename() && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw Error(Fault::kUsage, "cannot write the run folder: " + reason, path.string(),
              "choose another one with -o");
}

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

}  // namespace

RunFolder::RunFolder(fs::path path, std::string effective_yaml, Console& console)
    : path_(without_slash(std::move(path))),
      effective_yaml_(std::move(effective_yaml)),
      console_(console) {
  std::error_code error;
  made_ = fs::create_directories(path_, error);
  if (error) fail(path_, error.message());
  lock_.emplace(path_);
  if (::access(path_.c_str(), W_OK) != 0) fail(path_, std::strerror(errno));
  holds_earlier_run_ = is_log_of_a_run(path_ / kRunLog);
  if (!holds_earlier_run_) {
    require_none_of({path_ / kRunLog});
    require_none_of(fixed_results(path_));
  }
  if (!is_list_of_a_run(path_ / kWrittenFiles)) require_none_of({path_ / kWrittenFiles});
  const NamedResults own = named_results(effective_yaml_);
  const NamedResults earlier = holds_earlier_run_ ? earlier_named_results(path_) : NamedResults();
  named_files_.assign(own.files.begin(), own.files.end());
  require_none_of(files_in_the_way(path_, own, earlier));
  const std::vector<fs::path> unfinished = unfinished_in(path_, earlier);
  add_earlier(unfinished);
  if (!unfinished.empty()) add_earlier(files_with_names_in(path_, earlier));  // it was killed
  for (const std::string& folder : earlier.picture_folders)
    add_earlier(pictures_in(path_ / folder));
  if (holds_earlier_run_) add_earlier(listed_in(path_));
  add_earlier(fixed_results(path_));  // last: they say which the others are
  require_replaceable();
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (made_ && !begun_) fs::remove(path_, ignored);
}

void RunFolder::begin() {
  AtomicFile pipeline(path_ / kRunPipeline);
  pipeline.stream() << effective_yaml_;
  pipeline.flush();  // a full disk is met before anything is removed
  begin_log();
  begun_ = true;
  remove_earlier_files();
  removed_ = true;
  pipeline.commit();  // last: the earlier one says which pictures are those of a run
}

void RunFolder::begin_log() {
  const std::lock_guard lock(mutex_);
  try {
    auto sink =
        std::make_shared<spdlog::sinks::basic_file_sink_mt>((path_ / kRunLog).string(), true);
    log_ = std::make_shared<spdlog::logger>("run", std::move(sink));
  } catch (const spdlog::spdlog_ex& exception) {
    fail(path_ / kRunLog, exception.what());
  }
  log_->set_pattern("%Y-%m-%d %H:%M:%S.%e  %l  %v");
  log_->set_level(spdlog::level::debug);
  log_->flush_on(spdlog::level::info);
  for (const auto& [level, text] : early_) log_->log(level_of(level), text);
}

void RunFolder::log(LogLevel level, std::string_view text) const {
  {
    const std::lock_guard lock(mutex_);
    if (log_)
      log_->log(level_of(level), text);
    else
      early_.emplace_back(level, text);
  }
  if (level == LogLevel::kWarning) console_.line("warning: " + std::string(text));
  if (level == LogLevel::kError) console_.line("error: " + std::string(text));
}

// What has another time now is this run's already.
void RunFolder::remove_earlier_files() const {
  if (holds_earlier_run_)
    console_.note("note: " + path_.string() + " holds an earlier run, which is overwritten");
  for (const auto& [file, written] : earlier_files_) {
    std::error_code error;
    if (fs::last_write_time(file, error) != written || error) continue;
    fs::remove(file, error);
    if (error) fail(file, error.message());
    remove_empty_folders(file.parent_path());
  }
}

// From `folder` upwards, below the run's own. A link to a folder is none of the run's.
void RunFolder::remove_empty_folders(fs::path folder) const {
  for (; folder != path_ && folder.has_relative_path(); folder = folder.parent_path())
    if (::rmdir(folder.c_str()) != 0) return;
}

void RunFolder::list_results(const std::vector<fs::path>& files_of_map) const {
  if (!removed_) return;  // the list of the earlier run still counts
  std::vector<fs::path> files;
  for (const fs::path& file : files_of_map) files.push_back("map" / file);
  files.insert(files.end(), named_files_.begin(), named_files_.end());
  std::erase_if(files,
                [](const fs::path& file) { return is_elsewhere(file) || is_fixed_result(file); });
  list_written(path_, files);
}

void RunFolder::require_no_input_in_the_way(const fs::path& input) const {
  std::error_code none;
  for (const auto& [file, written] : earlier_files_)
    if (fs::equivalent(file, input, none))
      throw Error(Fault::kUsage,
                  "is a result of the earlier run in the folder, which this run removes",
                  input.string(), "choose another folder with -o, or move it");
}

void RunFolder::require_no_result_in_place_of(const fs::path& map) const {
  std::vector<fs::path> results = fixed_results(path_);
  std::erase(results, path_ / kRunMap);
  results.push_back(path_ / kRunLog);
  for (const fs::path& file : named_files_) results.push_back(path_ / file);
  const fs::path place = fs::weakly_canonical(map);
  for (const fs::path& result : results)
    if (fs::weakly_canonical(result) == place)
      throw Error(Fault::kUsage, "two results of the run have this name", map.string(),
                  "choose another one for the map");
}

std::vector<std::string> RunFolder::contents() const {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_))
    names.push_back(entry.path().filename().string() + (entry.is_directory() ? "/" : ""));
  std::sort(names.begin(), names.end());
  return names;
}

// Before the run rather than in the middle of it: after another user's run, a container's, for
// example.
void RunFolder::require_replaceable() const {
  if (holds_earlier_run_ && ::access((path_ / kRunLog).c_str(), W_OK) != 0)
    fail(path_ / kRunLog, std::strerror(errno));
  for (const auto& [file, written] : earlier_files_)
    if (::access(file.parent_path().c_str(), W_OK) != 0)
      fail(file.parent_path(), std::strerror(errno));
}

// Every run has a log. A pipeline.yaml without one is the user's, who runs it where it lies; so are
// maps and numbered pictures.
void RunFolder::require_none_of(const std::vector<fs::path>& files) const {
  std::error_code none;
  for (const fs::path& file : files)
    if (fs::exists(file, none))
      throw Error(Fault::kUsage, "is no file of an earlier run, and would be replaced",
                  file.string(), "choose another folder with -o, or move it");
}

void RunFolder::add_earlier(const std::vector<fs::path>& files) {
  std::error_code error;
  for (const fs::path& file : files)
    if (const auto written = fs::last_write_time(file, error);
        !error && !fs::is_directory(file, error))
      earlier_files_.emplace_back(file, written);
}

}  // namespace stillpoint
