// The camera that a CameraInfo describes.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include "parameters.hpp"
#include "session.hpp"

namespace stillpoint_ros {

/// K and the distortion of Brown and Conrady (plumb_bob), or with `rectified` P; depth as the
/// parameters say. Throws stillpoint::Error(kData) when the camera is not calibrated, or has
/// another distortion.
SensorCamera camera_of(const sensor_msgs::CameraInfo& info, const Parameters& parameters);

}  // namespace stillpoint_ros
