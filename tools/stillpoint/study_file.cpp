#include "study_file.hpp"

#include "commands.hpp"
#include "scene_file.hpp"
#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"
#include "study_check.hpp"
#include "study_grid.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using study::Sequence;
using study::Study;
using study::Variant;

void check_version(const ConfigNode& tree, FaultList& faults) {
  const ConfigNode* version = tree.find("version");
  if (!version)
    faults.add(tree.location, "there is no version; write 'version: 1'");
  else if (version->scalar != "1")
    faults.add(version->location, "version '" + version->scalar +
                                      "' is not known to this program, which reads version 1");
}

/// With a variant for each combination of its grids. Throws where nothing more can be said.
ConfigNode load_tree(const fs::path& file, FaultList& faults) {
  ConfigNode tree = load_config_file(file, "studies", faults);
  faults.throw_if_any();
  remove_nulls(tree);
  tree.key_location = tree.location;
  check_version(tree, faults);
  FaultList of_grids;
  expand_grids(tree, of_grids);
  of_grids.throw_if_any();
  return tree;
}

/// Returns every option with its value, as YAML.
std::string read_options(const ConfigNode& tree, Study& study, FaultList& faults) {
  YamlOptionReader reader(&tree, "study");
  reader.ignore("version");
  study.visit(reader);
  reader.finish();
  faults.add(reader.faults());
  return print_yaml(reader.record());
}

/// A file beside the study becomes absolute; a name, or a file seen from the working folder, stays.
void resolve(std::string& name_or_file, const fs::path& folder) {
  std::error_code error;
  if (!name_or_file.empty() && fs::is_regular_file(folder / name_or_file, error))
    name_or_file = fs::weakly_canonical(folder / name_or_file).string();
}

}  // namespace

StudyFile load_study(const std::string& name_or_file, Registry& registry) {
  StudyFile result{.file = find_config(name_or_file, "studies"), .study = {}, .effective_yaml = {}};
  FaultList faults;
  ConfigNode tree = load_tree(result.file, faults);
  FaultList unset;
  substitute_environment(tree, unset);
  faults.add(unset);
  if (!unset.empty()) faults.throw_if_any();  // each path with it would be one more fault
  result.effective_yaml = "version: 1\n" + read_options(tree, result.study, faults);
  const fs::path folder = fs::absolute(result.file).parent_path();
  for (Sequence& sequence : result.study.sequences) {
    resolve(sequence.scene, folder);
    resolve(sequence.camera, folder);
  }
  for (Variant& variant : result.study.variants) resolve(variant.pipeline, folder);
  const LateCalls late = watch_loading();
  check_study(tree, result.study, registry, std::move(faults));
  return result;
}

Study read_study(const fs::path& file) {
  FaultList faults;
  const ConfigNode tree = load_tree(file, faults);
  Study study;
  read_options(tree, study, faults);
  faults.throw_if_any();
  return study;
}

PipelineRequest request_of(const Study& study, const Sequence& sequence, const Variant& variant,
                           const fs::path& recording) {
  PipelineRequest request{.pipeline = variant.pipeline,
                          .dataset = recording,
                          .camera = sequence.camera,
                          .assignments = study::assignments_of(study, variant)};
  return request;
}

std::string describe_scene(const Sequence& sequence) {
  SceneFile file = load_scene(sequence.scene, sequence.set);
  if (sequence.frames > 0) file.scene.frames = sequence.frames;
  YamlOptionReader printer(nullptr, "source");
  file.scene.visit(printer);
  return camera_yaml(file.camera) + print_yaml(printer.record());
}

}  // namespace stillpoint
