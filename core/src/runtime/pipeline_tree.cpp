#include "stillpoint/runtime/pipeline_tree.hpp"

#include <algorithm>
#include <utility>

#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/runtime/section_file.hpp"
#include "stillpoint/support/bag_files.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

ConfigNode scalar(std::string key, std::string value, const Location& where) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kScalar;
  node.key = std::move(key);
  node.scalar = std::move(value);
  node.location = node.key_location = where;
  return node;
}

std::string source_type_in(const ConfigNode& tree) {
  const ConfigNode* source = tree.find("source");
  const ConfigNode* type = source ? source->find("type") : nullptr;
  return type ? type->scalar : "";
}

/// The two sources of recordings stand in for each other, so that every pipeline takes both kinds;
/// another source gets what it is given.
std::string source_type_for(const fs::path& dataset, const std::string& written) {
  if (written == "tum_rgbd" && !bag_files(dataset).empty()) return "bag";
  std::error_code error;
  if (written == "bag" && fs::exists(dataset / "rgb.txt", error)) return "tum_rgbd";
  return written;
}

/// `source: {path: DIR}` as if it were written on the command line. Of an empty type, only the
/// path.
ConfigNode dataset_overlay(const fs::path& dataset, const std::string& type) {
  const Location where{"--dataset " + dataset.string()};
  ConfigNode source = empty_map(where);
  source.key = "source";
  source.key_location = where;
  if (!type.empty()) source.children.push_back(scalar("type", type, where));
  source.children.push_back(
      scalar("path", fs::absolute(dataset).lexically_normal().string(), where));
  ConfigNode tree = empty_map(where);
  tree.children.push_back(std::move(source));
  return tree;
}

ConfigNode command_line_overlay(const PipelineRequest& request, const ConfigNode& tree,
                                FaultList& faults, ConfigFiles& files) {
  ConfigNode overlay = empty_map({});
  if (!request.dataset.empty()) {
    const std::string written = source_type_in(tree);
    const std::string type = source_type_for(request.dataset, written);
    overlay = dataset_overlay(type == "bag" ? bag_path(request.dataset) : request.dataset,
                              type == written ? "" : type);
  }
  for (const std::string& assignment : request.assignments) {
    ConfigNode change = parse_assignment(assignment, faults);
    load_named_sections(change, faults, files);
    overlay = merge_sections(std::move(overlay), change);
  }
  return overlay;
}

/// `type: TYPE`, and the option of `TYPE.OPTION=VALUE`.
ConfigNode output_from(const std::string& words, const Location& where, FaultList& faults) {
  ConfigNode output = empty_map(where);
  std::string type = words;
  if (words.find('=') != std::string::npos) {
    const ConfigNode assigned = parse_assignment(words, faults, "--with");
    if (assigned.children.empty()) return output;
    type = assigned.children.front().key;
    output.children = assigned.children.front().children;
  }
  output.children.push_back(scalar("type", type, where));
  return output;
}

/// At the end of `outputs:`, or over the first one of its type; what is no list is a fault that is
/// found later.
void add_output(ConfigNode& tree, const std::string& words, FaultList& faults) {
  const Location where{"--with " + words};
  const ConfigNode output = output_from(words, where, faults);
  const ConfigNode* type = output.find("type");
  if (!type) return;
  if (!tree.find("outputs")) {
    ConfigNode list;
    list.kind = ConfigNode::Kind::kList;
    list.key = "outputs";
    list.location = list.key_location = where;
    tree.set(std::move(list));
  }
  ConfigNode* outputs = tree.find("outputs");
  if (outputs->kind != ConfigNode::Kind::kList) return;
  const auto same = std::ranges::find_if(outputs->children, [&](const ConfigNode& other) {
    const ConfigNode* its = other.find("type");
    return its && its->scalar == type->scalar;
  });
  if (same == outputs->children.end())
    outputs->children.push_back(output);
  else
    *same = merge(*same, output);
}

/// The camera.yaml of the recording that the source reads; empty when there is none.
fs::path camera_beside_recording(const ConfigNode& tree) {
  const fs::path recording = recording_of(tree);
  if (recording.empty()) return {};
  const fs::path file = recording / "camera.yaml";
  std::error_code error;
  return fs::is_regular_file(file, error) ? file : fs::path{};
}

}  // namespace

ConfigNode load_pipeline_tree(const fs::path& file, const PipelineRequest& request,
                              FaultList& faults, ConfigFiles& files) {
  const auto finished = [&](ConfigNode tree, FaultList& list) {
    substitute_environment(tree, list);
    remove_nulls(tree);
    return tree;
  };
  const auto with_sections = [&](ConfigNode& written) {
    load_named_sections(written, faults, files);
  };
  ConfigNode tree = load_config_file(file, "pipelines", faults, with_sections, files);
  if (refuse_settings_of_orb_slam(tree, faults)) return {};
  const ConfigNode overlay = command_line_overlay(request, tree, faults, files);

  fs::path camera_file;
  FaultList found_again;  // by the last line
  if (!request.camera.empty())
    camera_file = find_config(request.camera, "cameras");
  else if (const ConfigNode* camera = tree.find("camera");
           !camera || camera->kind == ConfigNode::Kind::kNull)
    camera_file = camera_beside_recording(finished(merge_sections(tree, overlay), found_again));
  if (!camera_file.empty()) tree.set(load_section(camera_file, "camera", faults, files));
  tree = finished(merge_sections(std::move(tree), overlay), faults);
  for (const std::string& words : request.outputs) add_output(tree, words, faults);
  return tree;
}

fs::path recording_of(const ConfigNode& tree) {
  const ConfigNode* source = tree.find("source");
  const ConfigNode* path = source ? source->find("path") : nullptr;
  if (!path || path->kind != ConfigNode::Kind::kScalar) return {};
  return path->folder / path->scalar;
}

}  // namespace stillpoint
