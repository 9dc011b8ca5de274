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
#include <map>
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
#include "written_files.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLog = "log.txt";
constexpr const char* kPipeline = "pipeline.yaml";
constexpr const char* kResults[] = {kPipeline,     "trajectory.txt", "keyframes.txt",
                                    "timings.csv", "frames.csv",     "summary.json",
                                    "run.mcap",    "sparse.map",     kWrittenFiles};
constexpr std::uintmax_t kLargestPipeline = 16 << 20;  // bytes
constexpr const char* kMaps[] = {"map.ot", "map.bt", "map.ply", "map.pgm", "map.yaml", "cloud.ply"};

// Outputs, and their option that names the file they write.
const std::map<std::string, std::string> kFileOption = {
    {"trajectory", "file"}, {"keyframes", "file"}, {"frames", "file"}, {"timings", "file"},
    {"summary", "file"},    {"mcap", "file"},      {"web", "record"}};

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

/// Those with fixed names, but for the log.
std::vector<fs::path> results_in(const fs::path& run) {
  std::vector<fs::path> files;
  for (const char* name : kResults) files.push_back(run / name);
  for (const char* name : kMaps) files.push_back(run / "map" / name);
  return files;
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (is_picture(entry.path())) files.push_back(entry.path());
  return files;
}

/// What the outputs of a pipeline write, as paths from the run folder.
struct NamedResults {
  std::multiset<std::string> files;
  std::set<std::string> picture_folders;  // with numbered pictures
};

NamedResults results_of(const YAML::Node& effective_pipeline) {
  NamedResults named;
  for (const YAML::Node& output : effective_pipeline["outputs"]) {
    const auto type = output["type"].as<std::string>();
    const auto option = kFileOption.find(type);
    if (type == "images") {
      named.picture_folders.insert(output["folder"].as<std::string>("images"));
    } else if (option != kFileOption.end()) {
      const auto file = output[option->second].as<std::string>("");
      if (!file.empty()) named.files.insert(fs::path(file).lexically_normal());
    }
  }
  return named;
}

/// Whether a normalised path leads out of the run folder.
bool is_elsewhere(const fs::path& file) { return file.is_absolute() || *file.begin() == ".."; }

/// Of a run that was here before.
NamedResults earlier_results(const fs::path& run) {
  try {
    NamedResults named = results_of(YAML::Load(read_input_file(run / kPipeline, kLargestPipeline)));
    std::erase_if(named.picture_folders, [](const fs::path& folder) {  // somebody has changed it
      return folder.is_absolute() || std::ranges::find(folder, fs::path("..")) != folder.end();
    });
    return named;
  } catch (const YAML::Exception&) {
    return {};
  } catch (const Error&) {  // no such file
    return {};
  }
}

/// Paths from the run folder, of those of `names` that `known` does not have.
template <class Names>
std::vector<fs::path> files_in(const fs::path& run, const Names& names, const Names& known) {
  std::vector<fs::path> files;
  for (const std::string& name : names)
    if (!known.contains(name)) files.push_back(run / name);
  return files;
}

/// Those that are there: a pipe or a device is there to be written into.
std::vector<fs::path> regular_files(std::vector<fs::path> files) {
  std::error_code none;
  std::erase_if(files, [&](const fs::path& file) { return !fs::is_regular_file(file, none); });
  return files;
}

/// Throws Error(kUsage) where one result would replace another.
void require_different(const NamedResults& results) {
  for (const std::string& file : results.files)
    if (results.files.count(file) > 1 || file == kLog || file == kPipeline || file == kWrittenFiles)
      throw Error(Fault::kUsage, "two results of the run have this name", file,
                  "give each output a 'file' of its own");
}

/// Files that a killed run has left.
std::vector<fs::path> unfinished_in(const fs::path& run, const NamedResults& named) {
  std::set<fs::path> folders = {run, run / "map"}, names;
  for (const std::string& folder : named.picture_folders) folders.insert(run / folder);
  for (const std::string& file : named.files) {
    if (is_elsewhere(file)) continue;
    folders.insert((run / file).parent_path());
    names.insert(run / file);
  }
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::path& folder : folders)
    for (const auto& entry : fs::directory_iterator(folder, none)) {
      const fs::path whole = entry.path().parent_path() / entry.path().stem().stem();
      if (is_unfinished(entry.path()) || (is_temporary(entry.path()) && names.contains(whole)))
        files.push_back(entry.path());
    }
  return files;
}

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
  holds_earlier_run_ = is_log_of_a_run(path_ / kLog);
  if (!holds_earlier_run_) {
    require_none_of({path_ / kLog});
    require_none_of(results_in(path_));
  }
  if (!is_list_of_a_run(path_ / kWrittenFiles)) require_none_of({path_ / kWrittenFiles});
  const NamedResults earlier = holds_earlier_run_ ? earlier_results(path_) : NamedResults();
  const NamedResults own = results_of(YAML::Load(effective_yaml_));
  require_different(own);
  named_files_.assign(own.files.begin(), own.files.end());
  for (const fs::path& folder : files_in(path_, own.picture_folders, earlier.picture_folders))
    require_none_of(pictures_in(folder));
  std::multiset<std::string> known = earlier.files;
  // Outside the folder it is the user who has named the file.
  std::ranges::copy_if(own.files, std::inserter(known, known.end()), is_elsewhere);
  known.insert(std::begin(kResults), std::end(kResults));  // these are looked at above
  require_none_of(regular_files(files_in(path_, own.files, known)));
  add_earlier(unfinished_in(path_, earlier));
  for (const std::string& folder : earlier.picture_folders)
    add_earlier(pictures_in(path_ / folder));
  if (holds_earlier_run_) add_earlier(listed_in(path_));
  add_earlier(results_in(path_));  // last: they say which the others are
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
  removed_ = true;
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
  std::erase_if(files, [](const fs::path& file) {
    const auto is_file = [&](const char* name) { return file == name; };
    return is_elsewhere(file) || std::ranges::any_of(kResults, is_file);
  });
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
