#include "stillpoint/engine/pipeline_config.hpp"

#include <algorithm>
#include <functional>

#include "stillpoint/contracts/segmenter.hpp"
#include "stillpoint/contracts/source.hpp"
#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/runtime/pipeline_tree.hpp"
#include "stillpoint/runtime/section_file.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

struct PluginsOptions {
  std::vector<std::string> paths;
  void visit(OptionVisitor& v) {
    v("paths", paths, {.help = "folders of plugins, searched first", .is_path = true});
  }
};

struct StageSection {
  const char* name;  // also the kind
  std::optional<StageSpec> PipelineConfig::*stage;
};

// In the order of the paper's Fig. 2, which is that of the effective file.
constexpr StageSection kStages[] = {
    {"segmenter", &PipelineConfig::segmenter},
    {"propagator", &PipelineConfig::propagator},
    {"moving_checker", &PipelineConfig::moving_checker},
    {"map_checker", &PipelineConfig::map_checker},
    {"decision", &PipelineConfig::decision},
    {"tracker", &PipelineConfig::tracker},
    {"local_mapper", &PipelineConfig::local_mapper},
    {"loop_closer", &PipelineConfig::loop_closer},
    {"map_backend", &PipelineConfig::map_backend},
};

using VisitMore = std::function<void(OptionVisitor&)>;

/// Reads the sections of one tree into a PipelineConfig.
class PipelineReader {
 public:
  PipelineReader(const ConfigNode& tree, Registry& registry, FaultList& faults)
      : tree_(tree), registry_(registry), faults_(faults), loaded_(faults.empty()) {}

  PipelineConfig read(const PipelineRequest& request) {
    PipelineConfig config;
    read_version();
    search_plugins(request.plugin_folders);
    read_camera(config);
    config.recording = recording_of(tree_);
    if (!request.pushed) read_source(config);
    read_options(config.segmentation, "segmentation");
    for (const StageSection& stage : kStages)
      config.*stage.stage = read_stage(section(stage.name), stage.name, stage.name, config);
    read_outputs(config);
    read_options(config.runtime, "runtime");
    report_unknown_sections();
    config.effective_yaml =
        "# Every option of this pipeline with its value. Loading this file gives the same one.\n" +
        print_yaml(document_);
    return config;
  }

 private:
  const ConfigNode* section(const char* name) const { return tree_.find(name); }

  void read_camera(PipelineConfig& config) {
    const ConfigNode* camera = section("camera");
    if (!camera) return;
    read_options(config.camera.emplace(), "camera");
    if (const std::string warning = warning_of_camera(*camera); !warning.empty())
      config.warnings.push_back(warning);
  }

  void read_version() {
    const ConfigNode* version = section("version");
    if (!version)
      add_missing("there is no version; write 'version: 1'");
    else if (version->scalar != "1")
      faults_.add(version->location, "version '" + version->scalar +
                                         "' is not known to this program, which reads version 1");
    document_.children.push_back({.name = "version", .value = "1"});
  }

  /// After a file that could not be read, nothing is known to be missing.
  void add_missing(const std::string& what) {
    if (loaded_) faults_.add(tree_.location, what);
  }

  void read_source(PipelineConfig& config) {
    const ConfigNode* node = section("source");
    if (!node) add_missing("there is no source section");
    if (node && !loaded_ && !node->find("type")) return;  // of --dataset, without its file
    config.source = read_stage(node, "source", "source", config);
  }

  template <OptionGroup Options>
  void read_options(Options& options, const char* name) {
    YamlOptionReader reader(section(name), name);
    options.visit(reader);
    reader.finish();
    faults_.add(reader.faults());
    document_.children.push_back(reader.record());
  }

  void search_plugins(const std::vector<std::filesystem::path>& folders) {
    PluginsOptions options;
    read_options(options, "plugins");
    for (const std::string& path : options.paths) {
      std::error_code error;
      if (!std::filesystem::is_directory(path, error))
        faults_.add(tree_.find("plugins")->find("paths")->location,
                    "plugins.paths: no folder '" + path + "'");
      registry_.search(path);
    }
    for (const auto& folder : folders) registry_.search(folder);
  }

  std::optional<StageSpec> read_stage(const ConfigNode* node, const std::string& path,
                                      const std::string& kind, PipelineConfig& config) {
    OptionRecord record;
    const bool segmenter = kind == Segmenter::kKind;
    const VisitMore more = [&](OptionVisitor& v) {
      if (segmenter) config.segmentation.visit_in_segmenter(v);
    };
    auto stage = node ? check_stage(*node, path, kind, more, record) : std::nullopt;
    if (stage) document_.children.push_back(std::move(record));
    return stage;
  }

  void read_outputs(PipelineConfig& config) {
    OptionRecord record{.name = "outputs", .kind = OptionRecord::Kind::kList};
    const ConfigNode* list = section("outputs");
    if (list && list->kind != ConfigNode::Kind::kList) {
      faults_.add(list->location,
                  "outputs must be a list, as in [{type: trajectory}]; on the command line, "
                  "--with TYPE.OPTION=VALUE changes one of them");
    } else if (list) {
      for (std::size_t i = 0; i < list->children.size(); ++i) {
        OptionRecord element;
        const std::string path = "outputs[" + std::to_string(i) + "]";
        OutputOptions options;
        const auto output = check_stage(
            list->children[i], path, "output", [&](OptionVisitor& v) { options.visit(v); },
            element);
        if (!output) continue;
        config.outputs.push_back({*output, options});
        record.children.push_back(std::move(element));
      }
    }
    document_.children.push_back(std::move(record));
  }

  /// Nothing when the section has no usable type; faults of options are collected. `more` visits
  /// the options that are the runtime's.
  std::optional<StageSpec> check_stage(const ConfigNode& node, const std::string& path,
                                       const std::string& kind, const VisitMore& more,
                                       OptionRecord& record) {
    YamlOptionReader reader(&node, path);
    reader.ignore("type");
    const ConfigNode* type = node.find("type");
    if (node.kind != ConfigNode::Kind::kMap) {
      faults_.add(reader.faults());
      return std::nullopt;
    }
    if (!type || type->kind != ConfigNode::Kind::kScalar) {
      const Location& where = type               ? type->location
                              : node.key.empty() ? node.location
                                                 : node.key_location;
      faults_.add(where, path + ": expected 'type: NAME', the implementation to use");
      return std::nullopt;
    }
    const PluginType* plugin = registry_.find(kind, type->scalar);
    if (!plugin) {
      faults_.add(type->location, registry_.explain_missing(kind, type->scalar));
      return std::nullopt;
    }
    more(reader);
    try {
      describe_options(*plugin, reader);
    } catch (const std::exception& error) {
      if (StageGuard::has_ended_a_call()) throw;
      faults_.add(type->location, path + " (" + plugin->type + "): " + error.what());
      return std::nullopt;
    }
    reader.finish();
    faults_.add(reader.faults());
    record = reader.record();
    record.children.insert(
        record.children.begin(),
        {.name = "type", .value = yaml_text(plugin->type), .comment = plugin->summary});
    return StageSpec(path, *plugin, std::make_shared<const ConfigNode>(node));
  }

  void report_unknown_sections() {
    std::vector<std::string> known = {"version", "extends",      "plugins", "camera",
                                      "source",  "segmentation", "outputs", "runtime"};
    for (const StageSection& stage : kStages) known.emplace_back(stage.name);
    for (const ConfigNode& child : tree_.children) {
      if (std::ranges::find(known, child.key) != known.end()) continue;
      const std::string hint = did_you_mean(child.key, known);
      faults_.add(child.key_location, "unknown section '" + child.key + "'" +
                                          (hint.empty() ? "; known: " + join(known) : hint));
    }
  }

  const ConfigNode& tree_;
  Registry& registry_;
  FaultList& faults_;
  const bool loaded_;
  OptionRecord document_{.kind = OptionRecord::Kind::kGroup};
};

}  // namespace

void RuntimeOptions::visit(OptionVisitor& v) {
  v.choice("mode", mode, {{"inline", Mode::kInline}, {"threaded", Mode::kThreaded}},
           {.help = "one thread with reproducible results, or one per stage"});
  v.choice("pace", pace, {{"free", Pace::kFree}, {"sensor", Pace::kSensor}},
           {.help = "free: every frame, as fast as possible; sensor: at the recorded pace, "
                    "dropping frames while tracking is busy"});
  v("seed", seed, {.min = 0, .help = "seed of all random numbers"});
  v("threads", threads,
    {.min = 1, .max = 256, .help = "threads of each solver; inline always uses 1"});
  v("stage_timeout", stage_timeout,
    {.min = 0, .max = 1e6, .unit = "s", .help = "a stage that takes longer is reported; 0: never"});
  v.choice("validate", validate, {{"cheap", Validate::kCheap}, {"full", Validate::kFull}},
           {.help = "checks of the stages' results; full: of every value, for authors of plugins"});
}

void SegmentationOptions::visit(OptionVisitor& v) {
  v.choice("schedule", schedule, {{"wait", Schedule::kWait}, {"latest", Schedule::kLatest}},
           {.help = "wait for each frame's labels (the paper), or take the latest there are"});
  v("interval_seconds", interval_seconds,
    {.min = 0,
     .max = 60,
     .unit = "s",
     .help =
         "with 'latest', the least time between two frames that the network takes; a longer one "
         "costs less processor time"});
  v("latency_seconds", latency_seconds,
    {.min = 0,
     .max = 60,
     .unit = "s",
     .help = "simulated delay of labels with 'latest' in mode inline"});
  v("max_labelled", max_labelled,
    {.min = 0,
     .max = 1,
     .help = "when one class covers a larger share of the image, all labels of that image are "
             "discarded"});
}

void SegmentationOptions::visit_in_segmenter(OptionVisitor& v) {
  v.choice("on_failure", on_failure,
           {{"stop", OnFailure::kStop}, {"continue", OnFailure::kContinue}},
           {.help = "end the run, or go on without labels for that frame"});
}

void OutputOptions::visit(OptionVisitor& v) {
  v.choice(
      "when_full", when_full,
      {{"auto", WhenFull::kAuto}, {"wait", WhenFull::kWait}, {"drop", WhenFull::kDrop}},
      {.help =
           "threaded, when the output is too slow: tracking waits, or frames are left out; auto: "
           "drop for viewers, wait for files"});
}

StageSpec::StageSpec(std::string section, const PluginType& type,
                     std::shared_ptr<const ConfigNode> options)
    : section_(std::move(section)), type_(type), options_(std::move(options)) {}

std::unique_ptr<OptionVisitor> StageSpec::reader() const {
  return std::make_unique<YamlOptionReader>(options_.get(), section_);
}

PipelineConfig load_pipeline(const PipelineRequest& request, Registry& registry) {
  ConfigFiles files;
  return load_pipeline(request, registry, files);
}

PipelineConfig load_pipeline(const PipelineRequest& request, Registry& registry,
                             ConfigFiles& files) {
  const std::filesystem::path file = find_config(request.pipeline, "pipelines");
  FaultList faults;
  const ConfigNode tree = load_pipeline_tree(file, request, faults, files);
  PipelineConfig config = PipelineReader(tree, registry, faults).read(request);
  faults.throw_if_any();
  config.file = file;
  return config;
}

}  // namespace stillpoint
