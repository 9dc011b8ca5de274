// Which build of the program and its plugins is tested.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace stillpoint::testing {

/// The name of a folder with a build that a sanitizer looks at: the tests themselves, which only
/// call the program, are those of another build, and so are plugins that misbehave.
inline const char* sanitized_build() { return std::getenv("STILLPOINT_SANITIZED_BUILD"); }

/// With `bin` and `lib` of the tested build.
inline std::filesystem::path build_folder() {
  return sanitized_build() ? sanitized_build() : STILLPOINT_BINARY_DIR;
}

}  // namespace stillpoint::testing
