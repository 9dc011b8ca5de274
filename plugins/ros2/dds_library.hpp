// Cyclone DDS, loaded when it is used.
#pragma once

#include "live_camera/driver_library.hpp"

namespace stillpoint::ros2 {

/// Throws Error(kUsage) when it is not installed.
const live_camera::DriverLibrary& dds_library();

}  // namespace stillpoint::ros2
