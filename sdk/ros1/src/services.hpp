// Services: save_map, load_map, reset.
#pragma once

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>
#include <vector>

#include "image_input.hpp"
#include "session.hpp"

namespace stillpoint_ros {

/// Answers with `success` and a message that says what was done, or why not.
class Services {
 public:
  /// `session` and `input` must outlive it; answers on the thread of the images. The file of the
  /// map is the node's parameter `map_file`.
  Services(const ros::NodeHandle& node, Session& session, ImageInput& input);

 private:
  void add(const std::string& name, std::function<std::string()> action);

  ros::NodeHandle node_;
  Session& session_;
  ImageInput& input_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace stillpoint_ros
