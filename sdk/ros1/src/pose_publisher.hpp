// What is published for every frame: tf, pose, odometry and state.
#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/node_handle.h>

#include <string>

#include "frames.hpp"
#include "session.hpp"

namespace stillpoint_ros {

class PosePublisher {
 public:
  /// `frames` must outlive it.
  PosePublisher(ros::NodeHandle node, Frames& frames);

  /// `state`, and of a tracked frame tf, `pose` and `odom`. `dropped`: pairs of images so far.
  void publish(const TrackedFrame& frame, const ros::Time& stamp, int dropped);
  /// `state` with an error: there is no pose.
  void publish_failure(const std::string& message);
  /// `state` with a warning: no pair of images has come for so long.
  void publish_silence(double seconds);

 private:
  void publish_pose(const TrackedFrame& frame, const ros::Time& stamp);

  Frames& frames_;
  ros::Publisher pose_, odometry_, state_;
};

/// Level OK while tracking and WARN otherwise; `message` is "tracking", "waiting" or "lost".
diagnostic_msgs::DiagnosticStatus state_message(const TrackedFrame& frame, int dropped);

}  // namespace stillpoint_ros
