#include "pose_publisher.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>

#include "pose_messages.hpp"

namespace stillpoint_ros {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::uint32_t kQueue = 10;
constexpr double kUnknownVariance = 1e6;

const char* text_of(TrackedFrame::State state) {
  switch (state) {
    case TrackedFrame::State::kTracking:
      return "tracking";
    case TrackedFrame::State::kLost:
      return "lost";
    case TrackedFrame::State::kWaiting:
      break;
  }
  return "waiting";
}

DiagnosticStatus status(int level, const std::string& message) {
  DiagnosticStatus status;
  status.level = static_cast<DiagnosticStatus::_level_type>(level);
  status.name = "stillpoint";
  status.message = message;
  return status;
}

void set_diagonal(boost::array<double, 36>& covariance, double value) {
  for (std::size_t i = 0; i < 6; ++i) covariance[7 * i] = value;
}

}  // namespace

DiagnosticStatus state_message(const TrackedFrame& frame, int dropped) {
  const bool tracking = frame.state == TrackedFrame::State::kTracking;
  DiagnosticStatus message =
      status(tracking ? DiagnosticStatus::OK : DiagnosticStatus::WARN, text_of(frame.state));
  const auto add = [&](const char* key, const std::string& value) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = value;
    message.values.push_back(pair);
  };
  add("frame", std::to_string(frame.index));
  add("dropped", std::to_string(dropped));
  add("inliers", std::to_string(frame.inliers));
  add("keyframes", std::to_string(frame.keyframes));
  add("landmarks", std::to_string(frame.landmarks));
  add("loops_closed", std::to_string(frame.loops_closed));
  if (tracking && frame.covariance)
    add("poorly_constrained", frame.poorly_constrained ? "true" : "false");
  return message;
}

PosePublisher::PosePublisher(ros::NodeHandle node, Frames& frames)
    : frames_(frames),
      pose_(node.advertise<geometry_msgs::PoseStamped>("pose", kQueue)),
      odometry_(node.advertise<nav_msgs::Odometry>("odom", kQueue)),
      state_(node.advertise<DiagnosticStatus>("state", kQueue, true)) {}

void PosePublisher::publish(const TrackedFrame& frame, const ros::Time& stamp, int dropped) {
  state_.publish(state_message(frame, dropped));
  if (frame.state == TrackedFrame::State::kTracking) publish_pose(frame, stamp);
}

void PosePublisher::publish_failure(const std::string& message) {
  state_.publish(status(DiagnosticStatus::ERROR, message));
}

void PosePublisher::publish_silence(double seconds) {
  const std::string whole = std::to_string(static_cast<int>(seconds));
  state_.publish(status(DiagnosticStatus::WARN, "no pair of images for " + whole + " s"));
}

void PosePublisher::publish_pose(const TrackedFrame& frame, const ros::Time& stamp) {
  const Mounting mounting = *frames_.mounting();
  const stillpoint::Pose map_from_base = mounting.map_from_base(frame.world_from_camera);
  frames_.broadcast(map_from_base, stamp);

  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = frames_.map();
  pose.header.stamp = stamp;
  pose.pose = pose_message(map_from_base);
  pose_.publish(pose);

  nav_msgs::Odometry odometry;
  odometry.header = pose.header;
  odometry.child_frame_id = mounting.base;
  odometry.pose.pose = pose.pose;
  if (frame.covariance)
    odometry.pose.covariance =
        covariance_message(*frame.covariance, mounting.base_from_camera, map_from_base);
  else
    set_diagonal(odometry.pose.covariance, kUnknownVariance);
  set_diagonal(odometry.twist.covariance, kUnknownVariance);  // velocity is not estimated
  odometry_.publish(odometry);
}

}  // namespace stillpoint_ros
