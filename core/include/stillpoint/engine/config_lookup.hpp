// Configuration files by name: `tum_fr3` for cameras/tum_fr3.yaml in one of the config folders.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// The file itself if there is one of that path, from `folder` when it is relative, else NAME.yaml
/// in `category` ("cameras", "pipelines") of the first config folder that has it. Throws
/// Error(kUsage) that suggests names.
STILLPOINT_EXPORT std::filesystem::path find_config(const std::string& name_or_file,
                                                    const std::string& category,
                                                    const std::filesystem::path& folder = {});

/// The names that find_config takes without a file of that path, in the order of the alphabet.
STILLPOINT_EXPORT std::vector<std::string> config_names(const std::string& category);

}  // namespace stillpoint
