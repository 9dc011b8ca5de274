// A camera whose images are rendered quickly.
#pragma once

#include "stillpoint/contracts/camera.hpp"

namespace stillpoint::simulation {

inline CameraModel small_camera() {
  return {.name = "small", .width = 160, .height = 120, .fx = 134, .fy = 135, .cx = 80, .cy = 60};
}

}  // namespace stillpoint::simulation
