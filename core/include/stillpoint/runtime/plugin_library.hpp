// One shared library, checked step by step before any of its code is used.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "stillpoint/plugin.hpp"

namespace stillpoint {

/// A loaded library or the reason why it cannot be used.
struct PluginLibrary {
  const PluginDescriptor* descriptor = nullptr;  ///< null: see `reason`
  std::shared_ptr<const void> handle;            ///< keeps the library loaded
  std::string reason;
};

/// The library stays loaded until the process ends. Throws Error(kStage) when its static
/// constructors throw, or a StageGuard had to end them: nothing more can be loaded into such a
/// process.
PluginLibrary load_plugin_library(const std::filesystem::path& file);

}  // namespace stillpoint
