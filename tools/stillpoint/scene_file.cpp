#include "scene_file.hpp"

#include "simulation/simulator.hpp"
#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"

namespace stillpoint {
namespace {

void check_sections(const ConfigNode& tree, const std::string& file, FaultList& faults) {
  for (const ConfigNode& section : tree.children)
    if (section.key != "version" && section.key != "camera" && section.key != "source")
      faults.add(section.key_location, "unknown section '" + section.key +
                                           "' in a scene file; expected 'camera' or 'source'");
  const ConfigNode* source = tree.find("source");
  const ConfigNode* type = source ? source->find("type") : nullptr;
  if (!source && faults.empty())
    faults.add({file, 1, 1}, "has no source section, as in 'source: {type: simulation}'");
  if (type && type->scalar != "simulation")
    faults.add(type->location,
               "source.type of a scene is 'simulation', not '" + type->scalar + "'");
}

template <OptionGroup T>
void read_section(const ConfigNode* section, const char* name, T& options, FaultList& faults) {
  YamlOptionReader reader(section, name);
  reader.ignore("type");
  options.visit(reader);
  reader.finish();
  faults.add(reader.faults());
}

}  // namespace

SceneFile load_scene(const std::string& name_or_file, const std::vector<std::string>& assignments) {
  FaultList faults;
  const std::filesystem::path file = find_config(name_or_file, "scenes");
  ConfigNode tree = load_config_file(file, "scenes", faults);
  for (const std::string& assignment : assignments)
    tree = merge_sections(std::move(tree), parse_assignment(assignment, faults));
  substitute_environment(tree, faults);
  remove_nulls(tree);
  check_sections(tree, file.string(), faults);
  SceneFile result{.camera = simulation::default_camera(), .scene = {}};
  if (const ConfigNode* camera = tree.find("camera"))
    read_section(camera, "camera", result.camera, faults);
  read_section(tree.find("source"), "source", result.scene, faults);
  faults.throw_if_any();
  return result;
}

}  // namespace stillpoint
