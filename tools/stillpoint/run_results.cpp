#include "run_results.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <regex>
#include <string_view>
#include <system_error>

#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"
#include "written_files.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResults[] = {kRunPipeline,  "trajectory.txt", "keyframes.txt",
                                    "timings.csv", "frames.csv",     "summary.json",
                                    "run.mcap",    kRunMap,          kWrittenFiles};
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

}  // namespace

NamedResults named_results(const std::string& effective_yaml) {
  NamedResults named = results_of(YAML::Load(effective_yaml));
  for (const std::string& file : named.files)
    if (named.files.count(file) > 1 || file == kRunLog || file == kRunPipeline ||
        file == kWrittenFiles)
      throw Error(Fault::kUsage, "two results of the run have this name", file,
                  "give each output a 'file' of its own");
  return named;
}

NamedResults earlier_named_results(const fs::path& run) {
  try {
    NamedResults named =
        results_of(YAML::Load(read_input_file(run / kRunPipeline, kLargestPipeline)));
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

std::vector<fs::path> files_in_the_way(const fs::path& run, const NamedResults& own,
                                       const NamedResults& earlier) {
  std::vector<fs::path> files;
  for (const std::string& folder : own.picture_folders)
    if (!earlier.picture_folders.contains(folder))
      for (const fs::path& picture : pictures_in(run / folder)) files.push_back(picture);
  std::error_code none;
  for (const std::string& file : own.files)
    if (!earlier.files.contains(file) && !is_elsewhere(file) && !is_fixed_result(file) &&
        fs::is_regular_file(run / file, none))
      files.push_back(run / file);
  return files;
}

bool is_elsewhere(const fs::path& file) { return file.is_absolute() || *file.begin() == ".."; }

std::vector<fs::path> fixed_results(const fs::path& run) {
  std::vector<fs::path> files;
  for (const char* name : kResults) files.push_back(run / name);
  for (const char* name : kMaps) files.push_back(run / "map" / name);
  return files;
}

bool is_fixed_result(const fs::path& file) {
  return std::ranges::any_of(kResults, [&](const char* name) { return file == name; });
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (is_picture(entry.path())) files.push_back(entry.path());
  return files;
}

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

std::vector<fs::path> files_with_names_in(const fs::path& run, const NamedResults& named) {
  std::vector<fs::path> files;
  for (const std::string& file : named.files)
    if (!is_elsewhere(file) && !is_fixed_result(file) && lies_in_run(run / file, run))
      files.push_back(run / file);
  return files;
}

// By its first line: "2026-01-30 12:00:00.000 info
// …". An empty one is: of a run that was killed at once.
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

}  // namespace stillpoint
