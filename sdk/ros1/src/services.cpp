#include "services.hpp"

#include <ros/console.h>

#include <stillpoint/error.hpp>
#include <utility>

#include "parameters.hpp"

namespace stillpoint_ros {

Services::Services(const ros::NodeHandle& node, Session& session, ImageInput& input)
    : node_(node), session_(session), input_(input) {
  add("save_map", [this] { return session_.save_map(map_file(node_)); });
  add("load_map", [this] {
    input_.forget();
    return session_.load_map(map_file(node_));
  });
  add("reset", [this] {
    input_.forget();
    return session_.reset();
  });
}

void Services::add(const std::string& name, std::function<std::string()> action) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  const boost::function<bool(Request&, Response&)> answer = [action = std::move(action), name](
                                                                Request&, Response& response) {
    try {
      response.message = action();
      response.success = true;
      ROS_INFO("%s: %s", name.c_str(), response.message.c_str());
    } catch (const stillpoint::Error& error) {
      response.message = error.what();
      response.success = false;
      ROS_ERROR("%s: %s", name.c_str(), error.what());
    }
    return true;
  };
  servers_.push_back(node_.advertiseService(name, answer));
}

}  // namespace stillpoint_ros
