// Scene files: a pipeline file's `camera:` and `source:` sections for the simulation, so that a
// pipeline can extend a scene and run on it without files in between.
#pragma once

#include <string>
#include <vector>

#include "simulation/scene_options.hpp"
#include "stillpoint/contracts/camera.hpp"

namespace stillpoint {

struct SceneFile {
  CameraModel camera;
  simulation::SceneOptions scene;
};

/// A file, or a name from configs/scenes; `assignments` as in `source.frames=100`.
/// Throws ConfigError with every fault found, or Error when there is no such file.
SceneFile load_scene(const std::string& name_or_file, const std::vector<std::string>& assignments);

}  // namespace stillpoint
