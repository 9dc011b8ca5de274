// Recordings, photographs and networks that are not part of the project.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace stillpoint::testing {

/// The folder that STILLPOINT_SHARED names, or `shared` beside the project. It need not exist.
inline std::filesystem::path shared_data() {
  const char* named = std::getenv("STILLPOINT_SHARED");
  return named ? named : STILLPOINT_SOURCE_DIR "/../shared";
}

}  // namespace stillpoint::testing
