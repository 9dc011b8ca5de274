#include "study/recordings.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "stillpoint/error.hpp"
#include "study/child_process.hpp"
#include "study/console_text.hpp"
#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescription = "simulated_from.yaml";

bool is_one_of(const fs::path& name, std::initializer_list<const char*> names) {
  return std::ranges::any_of(names, [&](const char* known) { return name == known; });
}

/// "1000.033333.png"
bool is_stamped_image(const fs::path& name) {
  return name.extension() == ".png" &&
         name.stem().string().find_first_not_of(".0123456789") == std::string::npos;
}

/// Of a path from the recording's folder: whether the simulator or the study writes it.
bool is_of_recording(const fs::path& path) {
  const auto is_folder = [](const fs::path& name) {
    return is_one_of(name, {"rgb", "depth", "labels", "instances"});
  };
  const fs::path folder = path.parent_path();
  if (!folder.empty()) return is_folder(folder) && is_stamped_image(path.filename());
  return is_folder(path) || is_one_of(path, {"rgb.txt", "depth.txt", "associations.txt",
                                             "groundtruth.txt", "camera.yaml", kDescription});
}

/// Throws Error(kUsage) for a folder that no study has made, or that has files of others: it stays.
void require_own_recording(const fs::path& folder) {
  std::error_code none;
  if (!fs::exists(folder, none) || fs::is_empty(folder, none)) return;
  if (!fs::exists(folder / kDescription, none))
    throw Error(Fault::kUsage, "is no recording of a study, and would be replaced", folder.string(),
                "move it, or choose another folder with -o");
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (!is_of_recording(entry.path().lexically_relative(folder)))
      throw Error(Fault::kUsage, "is no file of the simulated recording that would be replaced",
                  entry.path().string(), "move it, or choose another folder with -o");
}

/// "x.1234.part": written beside `folder`, under a name that is no other sequence's.
fs::path unfinished(const fs::path& folder) {
  return folder.string() + '.' + std::to_string(::getpid()) + ".part";
}

/// Those of studies that were killed: what the simulator said lies beside each.
void remove_unfinished(const fs::path& folder) {
  const std::string begin = folder.filename().string() + '.';
  std::vector<fs::path> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder.parent_path(), none)) {
    const std::string name = entry.path().filename().string();
    const std::size_t end = name.rfind(".part");  // of x.1234.part and x.1234.part.txt
    if (!name.starts_with(begin) || end == std::string::npos || end < begin.size()) continue;
    if (name.substr(end) != ".part" && name.substr(end) != ".part.txt") continue;
    const std::string number = name.substr(begin.size(), end - begin.size());
    const bool is_number = !number.empty() && std::ranges::all_of(number, [](unsigned char c) {
      return std::isdigit(c);
    });
    const fs::path part = entry.path().parent_path() / (name.substr(0, end) + ".part");
    if (is_number && fs::is_directory(part, none) &&
        fs::is_regular_file(part.string() + ".txt", none) &&
        !fs::exists(entry.path() / kDescription, none))
      found.push_back(entry.path());
  }
  for (const fs::path& path : found) remove_folder(path);
}

}  // namespace

bool is_recorded(const fs::path& folder, const std::string& description) {
  return read_text(folder / kDescription) == description;
}

bool is_recorded_otherwise(const fs::path& folder, const std::string& description) {
  std::error_code none;
  return fs::exists(folder / kDescription, none) && !is_recorded(folder, description);
}

bool record(const fs::path& program, const Sequence& sequence, const std::string& description,
            const fs::path& folder, const std::stop_token& stop) {
  const fs::path part = unfinished(folder);
  const fs::path console = part.string() + ".txt";
  require_own_recording(folder);
  remove_unfinished(folder);
  remove_folder(folder);
  make_folder(folder.parent_path());
  std::vector<std::string> command = {program, "simulate", sequence.scene, "-o", part};
  if (sequence.frames > 0)
    command.insert(command.end(), {"--frames", std::to_string(sequence.frames)});
  for (const std::string& assignment : sequence.set)
    command.insert(command.end(), {"--set", assignment});
  const ProcessEnd end = run_process(std::move(command), console, stop);
  if (end.exit_code != 0) {
    if (stop.stop_requested()) return false;
    throw Error(Fault::kStage, "simulating it failed: " + failure_text(console, end),
                "sequence '" + sequence.name + "'");
  }
  write_text(part / kDescription, description);
  std::error_code error;
  fs::rename(part, folder, error);
  if (error) throw Error(Fault::kUsage, "cannot be made: " + error.message(), folder.string());
  remove_folder(console);  // last: without it, `part` is not known for the study's own
  return true;
}

}  // namespace stillpoint::study
