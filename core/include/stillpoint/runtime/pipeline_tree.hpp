// All that a user says about a pipeline, merged into one tree.
#pragma once

#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/runtime/config_node.hpp"
#include "stillpoint/runtime/fault_list.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"

namespace stillpoint {

/// From weak to strong: the file with what it extends, --camera (or the camera.yaml beside the
/// recording when neither names one), --dataset, --set. Values are substituted, keys without a
/// value removed.
ConfigNode load_pipeline_tree(const std::filesystem::path& file, const PipelineRequest& request,
                              FaultList& faults, ConfigFiles& files);

/// As load_pipeline of the engine, for many pipelines: files that they share are read once.
STILLPOINT_EXPORT PipelineConfig load_pipeline(const PipelineRequest& request, Registry& registry,
                                               ConfigFiles& files);

/// The recording that the source reads, its option `path`; empty when it has none.
std::filesystem::path recording_of(const ConfigNode& tree);

}  // namespace stillpoint
