// stillpoint plugins new: a project for a plugin of one's own.
#pragma once

#include <CLI/CLI.hpp>

namespace stillpoint {

/// Adds `new` to the command `plugins`.
void add_plugins_new(CLI::App& plugins);

}  // namespace stillpoint
