#include "study_plan.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "stillpoint/engine/install_layout.hpp"
#include "stillpoint/runtime/pipeline_tree.hpp"
#include "stillpoint/support/model_lookup.hpp"
#include "study/child_process.hpp"
#include "study/pipeline_fingerprint.hpp"
#include "study_file.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using namespace study;

std::vector<fs::path> folders_of_models(const Registry& registry) {
  std::vector<fs::path> folders = model_folders(nullptr);
  for (const PluginType& type : registry.types()) {
    const fs::path own = fs::path(type.library).parent_path() / "models";
    if (std::ranges::find(folders, own) == folders.end()) folders.push_back(own);
  }
  return folders;
}

/// Not part of what the run is: without them, its results are the same.
std::vector<std::string> pictures_of(const Study& study, const Cell& cell) {
  if (study.pictures == 0 || cell.repeat > 0) return {};
  return {"--with", "images.worst=" + std::to_string(study.pictures),
          "--with", "images.panels=true",
          "--with", "images.every=1000000"};
}

std::vector<std::string> command_of(const PipelineRequest& request, const fs::path& run, int seed) {
  std::vector<std::string> command = {
      this_program(), "run", request.pipeline, "--dataset", request.dataset, "-o", run};
  if (!request.camera.empty()) command.insert(command.end(), {"--camera", request.camera});
  for (const std::string& assignment : request.assignments)
    command.insert(command.end(), {"--set", assignment});
  command.insert(command.end(), {"--set", "runtime.seed=" + std::to_string(seed)});
  return command;
}

/// Whatever several cells share is read once.
class Planner {
 public:
  Planner(const Study& study, const fs::path& output, Registry& registry)
      : study_(study),
        output_(output),
        registry_(registry),
        pipelines_(folders_of_models(registry)) {}

  PlannedCell plan(const Cell& cell) {
    const Sequence sequence = at_repeat(study_, study_.sequences[cell.sequence], cell.repeat);
    const fs::path recording = recording_of(output_, study_, cell.sequence, cell.repeat);
    const PipelineRequest request =
        request_of(study_, sequence, study_.variants[cell.variant], recording);
    if (cell.repeat == 0 || recording != last_recording_) pipeline_ = pipeline_of(request);
    last_recording_ = recording;
    const int seed = study_.seed + cell.repeat;
    const fs::path run = run_folder(output_, study_, cell);
    std::vector<std::string> command = command_of(request, run, seed);
    for (std::string& word : pictures_of(study_, cell)) command.push_back(std::move(word));
    return {.cell = cell,
            .command = std::move(command),
            .run = run,
            .recording = recording,
            .fingerprint = cell_fingerprint(pipeline_, fingerprint_of(recording), seed),
            .time_limit = study_.time_limit};
  }

 private:
  std::string pipeline_of(const PipelineRequest& request) {
    const PipelineConfig config = load_pipeline(request, registry_, files_);
    return pipelines_.of(config.effective_yaml, config.recording);
  }

  const std::string& fingerprint_of(const fs::path& recording) {
    const auto [known, is_new] = recordings_.try_emplace(recording);
    if (is_new) known->second = recording_fingerprint(recording);
    return known->second;
  }

  const Study& study_;
  const fs::path& output_;
  Registry& registry_;
  ConfigFiles files_;
  PipelineFingerprints pipelines_;
  std::map<fs::path, std::string> recordings_;
  fs::path last_recording_;
  std::string pipeline_;  // fingerprint of the last cell's: repeats share it
};

}  // namespace

std::vector<PlannedCell> plan_cells(const Study& study, const std::vector<Cell>& cells,
                                    const fs::path& output, Registry& registry) {
  Planner planner(study, output, registry);
  std::vector<PlannedCell> plan;
  plan.reserve(cells.size());
  for (const Cell& cell : cells) plan.push_back(planner.plan(cell));
  return plan;
}

// Plugins of the user are files that a pipeline names, by their folder.
std::vector<fs::path> files_of_program(const Registry& registry) {
  std::vector<fs::path> files = {this_program()};
  const std::vector<fs::path> own = default_plugin_folders();
  for (const PluginType& type : registry.types())
    if (std::ranges::find(own, fs::path(type.library).parent_path()) != own.end())
      files.push_back(type.library);
  return files;
}

}  // namespace stillpoint
