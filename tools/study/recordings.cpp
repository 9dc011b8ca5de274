#include "study/recordings.hpp"

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

/// Throws Error(kUsage) for a folder that no study has made: it stays.
void require_own(const fs::path& folder) {
  std::error_code none;
  if (!fs::exists(folder, none) || fs::is_empty(folder, none)) return;
  if (!fs::exists(folder / kDescription, none))
    throw Error(Fault::kUsage, "is no recording of a study, and would be replaced", folder.string(),
                "move it, or choose another folder with -o");
}

}  // namespace

bool is_recorded(const fs::path& folder, const std::string& description) {
  return read_text(folder / kDescription) == description;
}

bool record(const fs::path& program, const Sequence& sequence, const std::string& description,
            const fs::path& folder, const std::stop_token& stop) {
  const fs::path part = folder.string() + ".part";
  const fs::path console = folder.string() + ".txt";
  require_own(folder);
  remove_folder(part);
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
  remove_folder(console);
  write_text(part / kDescription, description);
  std::error_code error;
  fs::rename(part, folder, error);
  if (error) throw Error(Fault::kUsage, "cannot be made: " + error.message(), folder.string());
  return true;
}

}  // namespace stillpoint::study
