// Which paths name a bag: a recording of ROS, or in its formats.
#pragma once

#include <filesystem>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// The folder of a metadata.yaml, which describes the bags beside it; any other path itself.
STILLPOINT_EXPORT std::filesystem::path bag_path(const std::filesystem::path& path);

/// Of bag_path(): the file itself when its name ends in .bag, .mcap or .db3, those of a folder in
/// the order in which they were recorded, or nothing when the path is no bag. Files that are
/// compressed as a whole (.mcap.zstd, .db3.zstd) are among them, unless they lie beside what is in
/// them. A folder with the lists of a TUM recording is none.
STILLPOINT_EXPORT std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path);

}  // namespace stillpoint
