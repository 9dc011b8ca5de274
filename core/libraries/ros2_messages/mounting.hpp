// How a camera lies on what carries it, and the map that follows from it.
#pragma once

#include <string>

#include "ros2_messages/frames.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::ros2_messages {

/// The map is where the base was at the first frame. By default the base is the camera, and the map
/// has x where that looked, y to its left, z up.
struct Mounting {
  std::string map = kMapFrame;      ///< name of the frame
  std::string base = kCameraFrame;  ///< name of the frame
  Pose map_from_world = ros2_messages::map_from_world();
  Pose base_from_camera = Pose::Identity();

  Pose map_from_base(const Pose& world_from_camera) const {
    return map_from_world * world_from_camera * base_from_camera.inverse();
  }
};

}  // namespace stillpoint::ros2_messages
