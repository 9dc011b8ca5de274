// Poses as messages of ROS.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <geometry_msgs/Transform.h>

#include <stillpoint/pose_math.hpp>

namespace stillpoint_ros {

geometry_msgs::Pose pose_message(const stillpoint::Pose& pose);
geometry_msgs::Transform transform_message(const stillpoint::Pose& pose);
stillpoint::Pose pose_of(const geometry_msgs::Transform& transform);

/// `in_camera` is the covariance of the camera's pose in its own frame (PoseUncertainty). What
/// comes out is that of the base, which the camera is fixed to, about the axes of the map.
geometry_msgs::PoseWithCovariance::_covariance_type covariance_message(
    const stillpoint::Matrix6d& in_camera, const stillpoint::Pose& base_from_camera,
    const stillpoint::Pose& map_from_base);

}  // namespace stillpoint_ros
