// Files that hold one section for others to use: cameras and segmenters.
#pragma once

#include <filesystem>
#include <string>

#include "stillpoint/runtime/config_node.hpp"
#include "stillpoint/runtime/fault_list.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"

namespace stillpoint {

/// The section `name` of a file, with everything the file extends; null after a fault.
ConfigNode load_section(const std::filesystem::path& file, const std::string& name,
                        FaultList& faults, ConfigFiles& files);

/// Adds a fault for a settings file of ORB-SLAM2 or 3; false: it is none.
bool refuse_settings_of_orb_slam(const ConfigNode& tree, FaultList& faults);

/// Of a `camera:` section; empty: it says all it should.
std::string warning_of_camera(const ConfigNode& camera);

/// Where a tree says `camera: NAME` or `segmenter: NAME`, puts the section of that file in its
/// place. NAME is a file, relative to the one that says it, or a name from the config folders.
void load_named_sections(ConfigNode& tree, FaultList& faults, ConfigFiles& files);

}  // namespace stillpoint
