// The `camera:` section of camera files.
#pragma once

#include <filesystem>

#include "stillpoint/runtime/config_node.hpp"
#include "stillpoint/runtime/fault_list.hpp"

namespace stillpoint {

/// The section of a camera file with everything it extends; null after a fault.
ConfigNode load_camera_section(const std::filesystem::path& file, FaultList& faults);

}  // namespace stillpoint
