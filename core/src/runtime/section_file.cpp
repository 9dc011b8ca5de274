#include "stillpoint/runtime/section_file.hpp"

#include <utility>

#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {

bool refuse_settings_of_orb_slam(const ConfigNode& tree, FaultList& faults) {
  const ConfigNode* focal_length = tree.find("Camera.fx");
  if (!focal_length) focal_length = tree.find("Camera1.fx");
  if (!focal_length) return false;
  faults.add(focal_length->key_location,
             "this is a settings file of ORB-SLAM; for a camera file, write 'camera: {width: …, "
             "height: …, fx: …, fy: …, cx: …, cy: …, depth_factor: …}'");
  return true;
}

ConfigNode load_section(const std::filesystem::path& file, const std::string& name,
                        FaultList& faults, ConfigFiles& files) {
  ConfigNode tree = load_config_file(file, name + "s", faults, {}, files);
  substitute_environment(tree, faults);
  remove_nulls(tree);
  if (refuse_settings_of_orb_slam(tree, faults)) return {};
  for (const ConfigNode& section : tree.children)
    if (section.key != name && section.key != "version")
      faults.add(section.key_location, "unknown section '" + section.key + "' in a " + name +
                                           " file; all keys stand below '" + name + ":'");
  const ConfigNode* found = tree.find(name);
  if (found && found->kind == ConfigNode::Kind::kMap) return *found;
  if (faults.empty())
    faults.add({file.string(), 1, 1}, "has no " + name + " section, as in '" + name + ": {…}'");
  return {};
}

void load_named_sections(ConfigNode& tree, FaultList& faults, ConfigFiles& files) {
  for (const std::string name : {"camera", "segmenter"}) {
    ConfigNode* named = tree.find(name);
    if (!named || named->kind != ConfigNode::Kind::kScalar) continue;
    substitute_environment(*named, faults);
    try {
      ConfigNode section =
          load_section(find_config(named->scalar, name + "s", named->folder), name, faults, files);
      section.key = name;
      section.replaces = true;
      tree.set(std::move(section));
    } catch (const Error& fault) {
      faults.add(named->location, name + ": " + fault.what());
      tree.erase(name);
    }
  }
}

// Most cameras of today give millimetres, and nothing but lengths tells that the unit is wrong.
std::string warning_of_camera(const ConfigNode& camera) {
  if (camera.find("depth_factor")) return "";
  return "the camera has no depth_factor: 5000, the format of TUM, is taken; depth images in "
         "millimetres need 'depth_factor: 1000'";
}

CameraModel load_camera(const std::string& name_or_file, std::vector<std::string>* warnings) {
  FaultList faults;
  ConfigFiles files;
  const ConfigNode section =
      load_section(find_config(name_or_file, "cameras"), "camera", faults, files);
  faults.throw_if_any();
  if (const std::string warning = warning_of_camera(section); warnings && !warning.empty())
    warnings->push_back(warning);
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
