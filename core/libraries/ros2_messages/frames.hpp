// The coordinate frames of recordings and runs, by REP 105, and the way from Stillpoint's world to
// them.
#pragma once

#include "stillpoint/pose_math.hpp"

namespace stillpoint::ros2_messages {

/// Does not move; jumps of the camera in it are loops that were closed.
inline constexpr const char* kMapFrame = "map";
/// x right, y down, z forward.
inline constexpr const char* kCameraFrame = "camera_color_optical_frame";

/// Stillpoint's world is the first camera's optical frame; the map has x where that camera looks, y
/// to its left, z up.
inline Pose map_from_world() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, 0, 1,  //
      -1, 0, 0,              //
      0, -1, 0;
  return pose;
}

}  // namespace stillpoint::ros2_messages
