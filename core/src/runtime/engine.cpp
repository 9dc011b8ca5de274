#include "stillpoint/engine/engine.hpp"

#include <iostream>
#include <utility>

#include "stillpoint/engine/folder_lock.hpp"
#include "stillpoint/engine/make_stages.hpp"
#include "stillpoint/engine/pipeline_warnings.hpp"
#include "stillpoint/engine/registry.hpp"
#include "stillpoint/runtime/pipeline.hpp"
#include "stillpoint/support/trajectory.hpp"

namespace stillpoint {
namespace {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw Error(Fault::kUsage, "cannot be made: " + error.message(), folder.string(),
                "choose another output_directory");
}

void require_same_layout(std::string_view abi) {
  if (abi == kAbiTag) return;
  throw Error(Fault::kUsage,
              "the program was compiled with " + std::string(abi) + ", Stillpoint with " + kAbiTag,
              "engine",
              "compile both with the same standard library, Eigen, OpenCV and processor flags "
              "(-march=native and -mavx change how Eigen lays out its objects)");
}

}  // namespace

void log_to_stderr(LogLevel level, std::string_view text) {
  if (level == LogLevel::kWarning) std::cerr << "warning: " + std::string(text) + '\n';
  if (level == LogLevel::kError) std::cerr << "error: " + std::string(text) + '\n';
}

Engine::Engine(EngineSetup setup, std::string_view abi) {
  require_same_layout(abi);
  Registry registry;
  const PipelineConfig config = load_pipeline(setup.request, registry);
  for (const std::string& warning : warnings_of(config)) setup.log(LogLevel::kWarning, warning);
  if (setup.localise_only && setup.known_map.empty())
    setup.log(LogLevel::kWarning, "localise_only without a known map: nothing can be tracked");
  if (!setup.output_directory.empty()) {
    make_folder(setup.output_directory);
    lock_ = std::make_unique<FolderLock>(setup.output_directory);
  }
  Stages stages = make_stages(config, setup.output_directory, setup.log);
  stages.known_map = std::move(setup.known_map);
  stages.localise_only = setup.localise_only;
  pipeline_ = std::make_unique<Pipeline>(std::move(stages), config.runtime, config.segmentation);
}

Engine::Engine(Stages stages, const RuntimeOptions& runtime,
               const SegmentationOptions& segmentation, std::shared_ptr<PaceClock> clock,
               std::string_view abi) {
  require_same_layout(abi);
  pipeline_ =
      std::make_unique<Pipeline>(std::move(stages), runtime, segmentation, std::move(clock));
}

Engine::~Engine() = default;
Engine::Engine(Engine&&) noexcept = default;

FrameReportPtr Engine::process(Frame frame) { return pipeline_->push(std::move(frame)); }

void Engine::run(std::stop_token stop) {
  const auto lock = std::move(lock_);  // released however the run ends
  pipeline_->run(std::move(stop));
}

void Engine::finish() {
  const auto lock = std::move(lock_);  // released however the run ends
  pipeline_->finish();
}

std::shared_ptr<const SparseMap> Engine::map() const { return pipeline_->map(); }

std::vector<LabelledPoint> Engine::dense_map() const { return pipeline_->dense_map(); }

bool Engine::save_dense_map(const std::filesystem::path& directory) const {
  return pipeline_->save_dense_map(directory);
}

const ClassNames& Engine::classes() const { return pipeline_->classes(); }

const std::vector<TrackedPose>& Engine::poses() const { return pipeline_->poses(); }

std::vector<StampedPose> Engine::trajectory() const {
  const auto current = map();
  std::vector<StampedPose> trajectory;
  for (const TrackedPose& pose : poses())
    if (const auto in_world = world_from_camera(*current, pose))
      trajectory.push_back({pose.time, *in_world});
  return trajectory;
}

}  // namespace stillpoint
