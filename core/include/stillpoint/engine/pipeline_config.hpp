// A pipeline file, read, merged with the command line and checked as a whole.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/engine/install_layout.hpp"
#include "stillpoint/engine/registry.hpp"
#include "stillpoint/engine/stages.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint {

/// Every fault of a configuration, one line `file:line:column: error: …` each.
class STILLPOINT_EXPORT ConfigError final : public Error {
 public:
  explicit ConfigError(const std::string& lines) : Error(Fault::kUsage, lines) {}
};

/// A pipeline file and what is changed of it.
struct PipelineRequest {
  std::string pipeline;  ///< a file, or a name from configs/pipelines
  /// The recording to read, relative to the working folder: replaces source.path, and exchanges the
  /// source types `tum_rgbd` and `bag` so that they fit it.
  std::filesystem::path dataset;
  std::string camera;                    ///< a file, or a name from configs/cameras
  std::vector<std::string> assignments;  ///< `key.sub=value`
  /// `TYPE`, added to the file's outputs where not there, or `TYPE.OPTION=VALUE`, with that option.
  std::vector<std::string> outputs;
  bool pushed = false;  ///< frames come from Engine::process(): without `source:`
  /// Searched after the file's own plugins.paths.
  std::vector<std::filesystem::path> plugin_folders = default_plugin_folders();
};

/// The `runtime:` section.
struct STILLPOINT_EXPORT RuntimeOptions {
  enum class Mode { kInline, kThreaded } mode = Mode::kThreaded;
  enum class Pace { kFree, kSensor } pace = Pace::kFree;
  int seed = 1;
  int threads = 1;            ///< of each solver; always 1 inline
  double stage_timeout = 60;  ///< seconds after which a call of a stage is reported; 0: never
  /// Checks of the stages' results; full: of every value, and the images of frames are read-only.
  enum class Validate { kCheap, kFull } validate = Validate::kCheap;

  bool validates_fully() const { return validate == Validate::kFull; }
  void visit(OptionVisitor& visitor);
};

/// The `segmentation:` section, and `segmenter.on_failure`: which labels each frame gets.
struct STILLPOINT_EXPORT SegmentationOptions {
  enum class Schedule { kWait, kLatest } schedule = Schedule::kWait;
  double interval_seconds = 0;   ///< with `latest`, between two frames that the network takes
  double latency_seconds = 0.1;  ///< with `latest` in mode inline, the simulated delay of labels
  double max_labelled = 0.9;     ///< largest share of the image that one class may cover
  enum class OnFailure { kStop, kContinue } on_failure = OnFailure::kStop;

  void visit(OptionVisitor& visitor);
  /// What stands in the `segmenter:` section, beside the options of the plugin.
  void visit_in_segmenter(OptionVisitor& visitor);
};

/// What stands in an element of `outputs:`, beside the options of the plugin.
struct STILLPOINT_EXPORT OutputOptions {
  WhenFull when_full = WhenFull::kAuto;

  void visit(OptionVisitor& visitor);
};

struct ConfigNode;

/// A stage section whose options have been found valid.
class STILLPOINT_EXPORT StageSpec {
 public:
  StageSpec(std::string section, const PluginType& type, std::shared_ptr<const ConfigNode> options);

  const std::string& section() const { return section_; }  ///< "tracker", "outputs[1]", …
  const std::string& kind() const { return type_.kind; }
  const std::string& type() const { return type_.type; }
  const PluginType& plugin() const { return type_; }

  /// See stillpoint::create.
  template <class Interface>
  std::shared_ptr<Interface> create(const StageContext& context) const {
    return stillpoint::create<Interface>(type_, *reader(), context);
  }

 private:
  std::unique_ptr<OptionVisitor> reader() const;

  std::string section_;
  PluginType type_;
  std::shared_ptr<const ConfigNode> options_;
};

struct OutputSpec {
  StageSpec stage;
  OutputOptions options;
};

/// A section left out is an empty optional: the built-in null stage.
struct PipelineConfig {
  std::filesystem::path file;
  std::filesystem::path recording;  ///< source.path; empty when there is none
  std::optional<CameraModel> camera;
  std::optional<StageSpec> source;  ///< always there, unless frames are pushed
  std::optional<StageSpec> segmenter;
  SegmentationOptions segmentation;
  std::optional<StageSpec> propagator;
  std::optional<StageSpec> moving_checker;
  std::optional<StageSpec> map_checker;
  std::optional<StageSpec> decision;
  std::optional<StageSpec> tracker;
  std::optional<StageSpec> local_mapper;
  std::optional<StageSpec> loop_closer;
  std::optional<StageSpec> map_backend;
  std::vector<OutputSpec> outputs;
  RuntimeOptions runtime;

  /// What the file should say, but leaves out; a sentence each.
  std::vector<std::string> warnings;

  /// The complete file: every option of every stage with its value, paths absolute, nothing
  /// inherited. Loading it gives the same configuration.
  std::string effective_yaml;
};

/// Reads and checks everything; nothing of it runs. Plugins are searched for in the file's
/// plugins.paths and then in the request's folders, and stay in `registry`.
/// Throws ConfigError with every fault found, or Error when there is no such file.
STILLPOINT_EXPORT PipelineConfig load_pipeline(const PipelineRequest& request, Registry& registry);

/// A camera by name from configs/cameras, or from a file with a `camera:` section. `warnings`: as
/// of a PipelineConfig.
STILLPOINT_EXPORT CameraModel load_camera(const std::string& name_or_file,
                                          std::vector<std::string>* warnings = nullptr);

/// The text of a camera file.
STILLPOINT_EXPORT std::string camera_yaml(CameraModel camera);

}  // namespace stillpoint
