#include "stillpoint/engine/make_stages.hpp"

#include <optional>
#include <string>
#include <utility>

#include "stillpoint/engine/stage_error.hpp"
#include "stillpoint/runtime/stage_requirement.hpp"

namespace stillpoint {
namespace {

ClassNames checked(ClassNames classes) {
  require_of_stage(classes.size() >= 2 && classes.size() <= 256,
                   "classes() gives " + std::to_string(classes.size()) + " names",
                   "give 2 to 256, that of the background first");
  return classes;
}

class StageMaker {
 public:
  StageMaker(const PipelineConfig& config, const std::filesystem::path& output_directory,
             const std::function<void(LogLevel, std::string_view)>& log)
      : config_(config), output_directory_(output_directory), log_(log) {}

  template <class Interface>
  Stage<Interface> make(const std::optional<StageSpec>& spec) const {
    if (!spec) return {};
    return {spec->create<Interface>(context_of(*spec)), spec->type()};
  }

  /// First of all, because the others are told its classes.
  Stage<Segmenter> make_segmenter() {
    Stage<Segmenter> segmenter = make<Segmenter>(config_.segmenter);
    if (segmenter.object)
      classes_ = in_stage("segmentation (" + segmenter.type + ")", {},
                          [&] { return checked(segmenter.object->classes()); });
    return segmenter;
  }

 private:
  StageContext context_of(const StageSpec& spec) const {
    const RuntimeOptions& runtime = config_.runtime;
    const bool deterministic = runtime.mode == RuntimeOptions::Mode::kInline;
    return {.seed = stage_seed(runtime.seed, spec.section()),
            .threads = deterministic ? 1 : runtime.threads,
            .deterministic = deterministic,
            .output_directory = output_directory_,
            .recording = config_.recording,
            .camera = config_.camera,
            .classes = classes_,
            .log = [log = log_, section = spec.section()](LogLevel level, std::string_view text) {
              log(level, section + ": " + std::string(text));
            }};
  }

  const PipelineConfig& config_;
  const std::filesystem::path& output_directory_;
  const std::function<void(LogLevel, std::string_view)>& log_;
  ClassNames classes_;
};

}  // namespace

Stages make_stages(const PipelineConfig& config, const std::filesystem::path& output_directory,
                   const std::function<void(LogLevel, std::string_view)>& log) {
  StageMaker maker(config, output_directory, log);
  Stage<Segmenter> segmenter = maker.make_segmenter();
  Stages stages{.source = maker.make<Source>(config.source),
                .segmenter = std::move(segmenter),
                .propagator = maker.make<Propagator>(config.propagator),
                .moving_checker = maker.make<MovingChecker>(config.moving_checker),
                .map_checker = maker.make<MapChecker>(config.map_checker),
                .decision = maker.make<Decision>(config.decision),
                .tracker = maker.make<Tracker>(config.tracker),
                .local_mapper = maker.make<LocalMapper>(config.local_mapper),
                .loop_closer = maker.make<LoopCloser>(config.loop_closer),
                .map_backend = maker.make<MapBackend>(config.map_backend),
                .map_directory = output_directory.empty() ? "" : output_directory / "map",
                .log = log};
  if (output_directory.empty()) return stages;
  for (const OutputSpec& output : config.outputs)
    stages.outputs.push_back({maker.make<Output>(output.stage), output.options.when_full});
  return stages;
}

// FNV-1a over the section's name, then the finaliser of SplitMix64: close seeds give unrelated
// streams.
std::uint64_t stage_seed(int run_seed, std::string_view section) {
  std::uint64_t hash = 0xcbf29ce484222325u ^ static_cast<std::uint64_t>(run_seed);
  for (const char c : section) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
  return hash ^ (hash >> 31);
}

}  // namespace stillpoint
