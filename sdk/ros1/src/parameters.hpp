// The private parameters of the node.
#pragma once

#include <ros/node_handle.h>

#include <filesystem>
#include <string>

#include "session.hpp"

namespace stillpoint_ros {

struct Parameters {
  SessionOptions session;  ///< `warn` is left empty

  std::string map_frame = "map";  ///< z up; `<map_frame>_optical` is the same place with z forward
  std::string odom_frame;    ///< not empty: tf has it above the base, map → odom is published
  std::string base_frame;    ///< not empty: tf knows where the camera is in it
  std::string camera_frame;  ///< empty: that of the colour images

  bool approximate = false;  ///< the two images of a pair need not have the very same time stamp
  double max_difference = 0.02;  ///< seconds between the images of a pair, if approximate
  int queue_size = 1;            ///< pairs that may wait for tracking; the oldest are dropped

  bool rectified = false;  ///< images are rectified: P of CameraInfo describes them, not K and D
  double depth_factor = 1000;  ///< value of one metre in depth images with 16 bits (REP 118: 1000)
  double min_depth = 0.3;      ///< metres; nearer measurements are dropped
  double max_depth = 10;       ///< metres; farther measurements are dropped
  double depth_noise = 0.02;   ///< metres at 1 m, of point features (Camera)
  double surface_noise = 0.002;  ///< metres at 1 m, of the sensor alone (Camera)

  double map_period = 5;  ///< seconds between two messages with a map, where they are subscribed
  bool load_map = false;  ///< begin with the map in `map_file`
};

/// Throws stillpoint::Error(kUsage) for a parameter of the wrong type, out of range or unknown.
Parameters read_parameters(const ros::NodeHandle& node);

/// The parameter `map_file`, as it is now: services save and load it. Absolute.
std::filesystem::path map_file(const ros::NodeHandle& node);

}  // namespace stillpoint_ros
