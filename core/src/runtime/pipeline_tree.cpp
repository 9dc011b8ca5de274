#include "stillpoint/runtime/pipeline_tree.hpp"

#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/runtime/section_file.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

/// `source: {path: DIR}` as if it were written on the command line.
ConfigNode dataset_overlay(const fs::path& dataset) {
  const Location where{"--dataset " + dataset.string()};
  ConfigNode path;
  path.kind = ConfigNode::Kind::kScalar;
  path.key = "path";
  path.scalar = fs::absolute(dataset).lexically_normal().string();
  path.location = path.key_location = where;
  ConfigNode source = empty_map(where);
  source.key = "source";
  source.key_location = where;
  source.children.push_back(std::move(path));
  ConfigNode tree = empty_map(where);
  tree.children.push_back(std::move(source));
  return tree;
}

ConfigNode command_line_overlay(const PipelineRequest& request, FaultList& faults) {
  ConfigNode overlay = request.dataset.empty() ? empty_map({}) : dataset_overlay(request.dataset);
  for (const std::string& assignment : request.assignments) {
    ConfigNode change = parse_assignment(assignment, faults);
    load_named_sections(change, faults);
    overlay = merge_sections(std::move(overlay), change);
  }
  return overlay;
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
                              FaultList& faults) {
  const auto finished = [&](ConfigNode tree, FaultList& list) {
    substitute_environment(tree, list);
    remove_nulls(tree);
    return tree;
  };
  ConfigNode tree = load_config_file(file, "pipelines", faults, [&](ConfigNode& written) {
    load_named_sections(written, faults);
  });
  const ConfigNode overlay = command_line_overlay(request, faults);

  fs::path camera_file;
  FaultList found_again;  // by the last line
  if (!request.camera.empty())
    camera_file = find_config(request.camera, "cameras");
  else if (const ConfigNode* camera = tree.find("camera");
           !camera || camera->kind == ConfigNode::Kind::kNull)
    camera_file = camera_beside_recording(finished(merge_sections(tree, overlay), found_again));
  if (!camera_file.empty()) tree.set(load_section(camera_file, "camera", faults));
  return finished(merge_sections(std::move(tree), overlay), faults);
}

fs::path recording_of(const ConfigNode& tree) {
  const ConfigNode* source = tree.find("source");
  const ConfigNode* path = source ? source->find("path") : nullptr;
  if (!path || path->kind != ConfigNode::Kind::kScalar) return {};
  return path->folder / path->scalar;
}

}  // namespace stillpoint
