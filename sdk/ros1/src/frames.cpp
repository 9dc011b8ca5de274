#include "frames.hpp"

#include <ros/console.h>

#include "pose_messages.hpp"

namespace stillpoint_ros {
namespace {

using stillpoint::Pose;

// tf of odometry may come a little later than the images.
const ros::Duration kOdometryPatience(0.1);

/// z forward, y down → x forward, z up.
Pose body_from_optical() {
  Eigen::Matrix3d rotation;
  rotation << 0, 0, 1,  //
      -1, 0, 0,         //
      0, -1, 0;
  return Pose(rotation);
}

geometry_msgs::TransformStamped stamped(const std::string& target, const std::string& source,
                                        const Pose& target_from_source, const ros::Time& stamp) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = target;
  message.header.stamp = stamp;
  message.child_frame_id = source;
  message.transform = transform_message(target_from_source);
  return message;
}

}  // namespace

std::optional<Mounting> Frames::find_mounting(const std::string& image_frame) {
  if (const auto known = mounting()) return known;
  const std::string& camera =
      parameters_.camera_frame.empty() ? image_frame : parameters_.camera_frame;
  Mounting found{camera, Pose::Identity(), body_from_optical()};
  if (!parameters_.base_frame.empty()) {
    const auto base_from_camera =
        look_up(parameters_.base_frame, camera, ros::Time(0), ros::Duration(0));
    if (!base_from_camera) return std::nullopt;
    found = {parameters_.base_frame, *base_from_camera, *base_from_camera};
  } else if (camera.empty()) {
    ROS_WARN_THROTTLE(10, "the colour images have no frame_id; set ~camera_frame");
    return std::nullopt;
  }
  broadcast_world(found);
  const std::lock_guard lock(mutex_);
  mounting_ = found;
  return found;
}

std::optional<Mounting> Frames::mounting() const {
  const std::lock_guard lock(mutex_);
  return mounting_;
}

void Frames::broadcast(const Pose& map_from_base, const ros::Time& stamp) {
  const std::string& odom = parameters_.odom_frame;
  if (odom.empty()) {
    broadcaster_.sendTransform(stamped(map(), mounting()->base, map_from_base, stamp));
    return;
  }
  if (const auto odom_from_base = look_up(odom, mounting()->base, stamp, kOdometryPatience))
    broadcaster_.sendTransform(
        stamped(map(), odom, map_from_base * odom_from_base->inverse(), stamp));
}

std::optional<Pose> Frames::look_up(const std::string& target, const std::string& source,
                                    const ros::Time& stamp, const ros::Duration& patience) {
  try {
    return pose_of(buffer_.lookupTransform(target, source, stamp, patience).transform);
  } catch (const tf2::TransformException& error) {
    ROS_WARN_THROTTLE(10, "tf does not know %s in %s: %s", source.c_str(), target.c_str(),
                      error.what());
    return std::nullopt;
  }
}

void Frames::broadcast_world(const Mounting& mounting) {
  static_broadcaster_.sendTransform(
      stamped(map(), world(), mounting.map_from_world, ros::Time::now()));
}

}  // namespace stillpoint_ros
