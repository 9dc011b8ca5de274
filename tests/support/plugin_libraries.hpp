// Where the plugins are that tests check.
#pragma once

#include <filesystem>
#include <string>

#include "support/build_folder.hpp"

namespace stillpoint::testing {

inline const std::filesystem::path kShippedPlugins = build_folder() / "lib/stillpoint/plugins";
/// Those of tests/plugins_bad.
inline const std::filesystem::path kBadPlugins =
    std::filesystem::path(STILLPOINT_BINARY_DIR) / "tests/plugins_bad/plugins";

inline std::string plugin_library(const std::filesystem::path& folder, const std::string& name) {
  return (folder / ("libstillpoint_" + name + ".so")).string();
}

}  // namespace stillpoint::testing
