#include <stillpoint/sdk.hpp>

#include "ros2/ros2_output.hpp"
#include "ros2/ros2_source.hpp"

using stillpoint::Output;
using stillpoint::provide;
using stillpoint::Source;

STILLPOINT_PLUGIN(ros2, "0.1.0",
                  provide<Source, stillpoint::ros2::Ros2Source>(
                      "ros2", "images that ROS 2 publishes, live, without ROS"),
                  provide<Output, stillpoint::ros2::Ros2Output>(
                      "ros2", "poses and maps on topics of ROS 2, live, without ROS"));
