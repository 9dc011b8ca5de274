// Which paths name a bag: a recording of ROS, or in its formats.
#pragma once

#include <filesystem>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// The file itself when its name ends in .bag, .mcap or .db3, those of a folder in the order in
/// which they were recorded, or nothing when the path is no bag. A folder with the lists of a TUM
/// recording is none.
STILLPOINT_EXPORT std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path);

}  // namespace stillpoint
