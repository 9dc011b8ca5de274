#include "run_folder.hpp"

#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLog = "log.txt";
constexpr const char* kPipeline = "pipeline.yaml";
constexpr const char* kResults[] = {kPipeline,    "trajectory.txt", "keyframes.txt", "timings.csv",
                                    "frames.csv", "summary.json",   "run.mcap",      "sparse.map"};
constexpr const char* kMapList = "files.txt";  // in map: what the back end has written
constexpr const char* kMaps[] = {"map.ot", "map.bt", "map.ply", "map.pgm", "map.yaml", "cloud.ply"};

// Outputs whose option `file` names what they write.
constexpr std::string_view kWithFile[] = {"trajectory", "keyframes", "frames",
                                          "timings",    "summary",   "mcap"};

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "000042.jpg"
bool is_picture(const fs::path& file) {
  const std::string number = file.stem().string();
  return number.size() >= 6 && is_number(number) &&
         (file.extension() == ".jpg" || file.extension() == ".png");
}

/// The temporary name of an AtomicFile, "trajectory.txt.1234-0.part".
bool is_temporary(const fs::path& file) {
  const std::string numbers = file.stem().extension().string();  // ".1234-0"
  const std::size_t dash = numbers.find('-');
  return file.extension() == ".part" && dash != std::string::npos &&
         is_number(numbers.substr(1, dash - 1)) && is_number(numbers.substr(dash + 1));
}

/// By its name, one that a run has not finished.
bool is_unfinished(const fs::path& file) {
  if (!is_temporary(file)) return false;
  const fs::path name = file.stem().stem();
  const auto is_name = [&](const char* known) { return name == known; };
  return std::ranges::any_of(kResults, is_name) || std::ranges::any_of(kMaps, is_name) ||
         is_picture(name);
}

/// Whether the file is a log that a run has begun, by its first line: "2026-01-30 12:00:00.000 info
/// …". An empty one is: of a run that was killed at once.
bool is_log_of_a_run(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return false;
  std::ifstream stream(file);
  if (!stream) return false;
  std::string line;
  if (!std::getline(stream, line)) return true;
  static const std::regex kBegin(
      R"(\d{4}-\d{2}-\d{2} \d{2}:\d{2}:\d{2}\.\d{3}  (debug|info|warning|error)  )");
  return std::regex_search(line, kBegin, std::regex_constants::match_continuous);
}

/// Files that a killed run has left.
std::vector<fs::path> unfinished_in(const fs::path& run, std::set<std::string> folders) {
  std::vector<fs::path> files;
  std::error_code none;
  folders.insert({".", "map"});
  for (const std::string& folder : folders)
    for (const auto& entry : fs::directory_iterator(run / folder, none))
      if (is_unfinished(entry.path())) files.push_back(entry.path());
  return files;
}

/// Those with fixed names, but for the log.
std::vector<fs::path> results_in(const fs::path& run) {
  std::vector<fs::path> files;
  for (const char* name : kResults) files.push_back(run / name);
  for (const char* name : kMaps) files.push_back(run / "map" / name);
  return files;
}

std::set<std::string> fixed_names() { return {std::begin(kResults), std::end(kResults)}; }

/// Of a name in a file that somebody may have changed.
bool is_below_its_folder(const fs::path& path) {
  return !path.empty() && path.is_relative() &&
         std::ranges::none_of(path, [](const fs::path& part) { return part == ".."; });
}

/// What the map back end of an earlier run has written, which may be of a plugin with files of its
/// own.
std::vector<fs::path> map_files_in(const fs::path& run) {
  std::vector<fs::path> files;
  std::ifstream list(run / "map" / kMapList);
  for (std::string name; std::getline(list, name);)
    if (is_below_its_folder(name)) files.push_back(run / "map" / name);
  if (!files.empty()) files.push_back(run / "map" / kMapList);
  return files;
}

std::vector<fs::path> pictures_in(const fs::path& run, const std::set<std::string>& folders) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const std::string& folder : folders)
    for (const auto& entry : fs::directory_iterator(run / folder, none))
      if (is_picture(entry.path())) files.push_back(entry.path());
  return files;
}

/// What the outputs of a pipeline write under names that it gives them.
struct NamedResults {
  std::set<std::string> files;
  std::set<std::string> picture_folders;  // with numbered pictures
};

NamedResults results_of(const YAML::Node& effective_pipeline) {
  NamedResults named;
  for (const YAML::Node& output : effective_pipeline["outputs"]) {
    const auto type = output["type"].as<std::string>();
    if (type == "images")
      named.picture_folders.insert(output["folder"].as<std::string>("images"));
    else if (std::ranges::find(kWithFile, type) != std::end(kWithFile) && output["file"])
      named.files.insert(output["file"].as<std::string>());
  }
  for (auto* names : {&named.files, &named.picture_folders})
    std::erase_if(*names, [](const std::string& name) { return !is_below_its_folder(name); });
  return named;
}

/// Of a run that was here before.
NamedResults earlier_results(const fs::path& run) {
  try {
    return results_of(YAML::Load(read_input_file(run / kPipeline)));
  } catch (const YAML::Exception&) {
    return {};
  } catch (const Error&) {  // no such file
    return {};
  }
}

std::vector<fs::path> files_in(const fs::path& run, const std::set<std::string>& names) {
  std::vector<fs::path> files;
  for (const std::string& name : names) files.push_back(run / name);
  return files;
}

/// Names in `names` that are not in `known`.
std::set<std::string> without(std::set<std::string> names, const std::set<std::string>& known) {
  std::erase_if(names, [&](const std::string& name) { return known.contains(name); });
  return names;
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
    : path_(std::move(path)), effective_yaml_(std::move(effective_yaml)), console_(console) {
  std::error_code error;
  made_ = fs::create_directories(path_, error);
  if (error) fail(path_, error.message());
  lock_.emplace(path_);
  if (::access(path_.c_str(), W_OK) != 0) fail(path_, std::strerror(errno));
  holds_earlier_run_ = is_log_of_a_run(path_ / kLog);
  if (!holds_earlier_run_) {
    require_none_of({path_ / kLog});
    require_none_of(results_in(path_));
  }
  const NamedResults earlier = holds_earlier_run_ ? earlier_results(path_) : NamedResults();
  const NamedResults own = results_of(YAML::Load(effective_yaml_));
  require_none_of(pictures_in(path_, without(own.picture_folders, earlier.picture_folders)));
  require_none_of(files_in(path_, without(without(own.files, earlier.files), fixed_names())));
  add_earlier(unfinished_in(path_, earlier.picture_folders));
  add_earlier(pictures_in(path_, earlier.picture_folders));
  add_earlier(files_in(path_, earlier.files));
  if (holds_earlier_run_) add_earlier(map_files_in(path_));
  add_earlier(results_in(path_));  // last: pipeline.yaml says where the others are
  require_replaceable();
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (made_ && !begun_) fs::remove(path_, ignored);
}

void RunFolder::begin() {
  AtomicFile pipeline(path_ / kPipeline);
  pipeline.stream() << effective_yaml_;
  pipeline.flush();  // a full disk is met before anything is removed
  begin_log();
  begun_ = true;
  remove_earlier_files();
  pipeline.commit();  // last: the earlier one says which pictures are those of a run
}

void RunFolder::begin_log() {
  const std::lock_guard lock(mutex_);
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>((path_ / kLog).string(), true);
    log_ = std::make_shared<spdlog::logger>("run", std::move(sink));
  } catch (const spdlog::spdlog_ex& exception) {
    fail(path_ / kLog, exception.what());
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

// From `folder` upwards, below the run's own.
void RunFolder::remove_empty_folders(fs::path folder) const {
  std::error_code not_empty;
  for (; folder != path_ && fs::remove(folder, not_empty); folder = folder.parent_path()) continue;
}

void RunFolder::list_map(const std::vector<fs::path>& files) const {
  if (files.empty()) return;
  AtomicFile list(path_ / "map" / kMapList);
  for (const fs::path& file : files) list.stream() << file.generic_string() << '\n';
  list.commit();
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
  if (holds_earlier_run_ && ::access((path_ / kLog).c_str(), W_OK) != 0)
    fail(path_ / kLog, std::strerror(errno));
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
