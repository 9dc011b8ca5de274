#include "stillpoint/runtime/camera_config.hpp"

#include "stillpoint/did_you_mean.hpp"
#include "stillpoint/runtime/config_lookup.hpp"
#include "stillpoint/runtime/pipeline_config.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"

namespace stillpoint {

ConfigNode load_camera_section(const std::filesystem::path& file, FaultList& faults) {
  ConfigNode tree = load_config_file(file, faults);
  substitute_environment(tree, faults);
  remove_nulls(tree);
  for (const ConfigNode& section : tree.children)
    if (section.key != "camera" && section.key != "version")
      faults.add(section.key_location,
                 "unknown section '" + section.key + "' in a camera file; expected 'camera'");
  if (const ConfigNode* camera = tree.find("camera")) return *camera;
  if (faults.empty())
    faults.add({file.string(), 1, 1}, "has no camera section, as in 'camera: {fx: 525, …}'");
  return {};
}

CameraModel load_camera(const std::string& name_or_file) {
  FaultList faults;
  const ConfigNode section = load_camera_section(find_config(name_or_file, "cameras"), faults);
  faults.throw_if_any();
  CameraModel camera;
  YamlOptionReader reader(&section, "camera");
  camera.visit(reader);
  reader.finish();
  reader.faults().throw_if_any();
  return camera;
}

std::string camera_yaml(CameraModel camera) {
  YamlOptionReader reader(nullptr, "camera");
  camera.visit(reader);
  OptionRecord document{.kind = OptionRecord::Kind::kGroup};
  document.children.push_back(reader.record());
  return print_yaml(document);
}

}  // namespace stillpoint
