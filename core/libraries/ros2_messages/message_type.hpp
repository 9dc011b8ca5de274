// Names and definitions of the messages of ROS 2 that can be written.
#pragma once

#include <string>
#include <string_view>

namespace stillpoint::ros2_messages {

/// "geometry_msgs/msg/PoseStamped".
std::string schema_name(std::string_view type);

/// The definition of a type such as "geometry_msgs/PoseStamped" and, behind lines of 80 '=', those
/// of all types in it: what MCAP calls `ros2msg`.
std::string schema_text(std::string_view type);

}  // namespace stillpoint::ros2_messages
