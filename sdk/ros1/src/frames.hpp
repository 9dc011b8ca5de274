// The frames of tf: map, odometry, base and camera (REP 103, REP 105).
#pragma once

#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <mutex>
#include <optional>
#include <stillpoint/pose_math.hpp>
#include <string>

#include "parameters.hpp"

namespace stillpoint_ros {

/// The map begins where the base is at the first frame: x forward, y left, z up. Without a base
/// frame the camera takes its place: x where it looks, z up in its image.
struct Mounting {
  std::string base;  ///< the base frame, or that of the camera
  stillpoint::Pose base_from_camera = stillpoint::Pose::Identity();
  stillpoint::Pose map_from_world = stillpoint::Pose::Identity();  ///< world: of the engine

  stillpoint::Pose map_from_base(const stillpoint::Pose& world_from_camera) const {
    return map_from_world * world_from_camera * base_from_camera.inverse();
  }
};

/// Calls from any thread.
class Frames {
 public:
  explicit Frames(const Parameters& parameters) : parameters_(parameters), listener_(buffer_) {}

  const std::string& map() const { return parameters_.map_frame; }
  /// The world of the engine: the place of `map()` with z forward, as in tf.
  std::string world() const { return parameters_.map_frame + "_optical"; }

  /// How the camera is mounted, asked of tf until that knows it, with a warning; nothing till then.
  /// `image_frame` is the frame of the colour images.
  std::optional<Mounting> find_mounting(const std::string& image_frame);
  /// What find_mounting() has found.
  std::optional<Mounting> mounting() const;

  /// Publishes map → base, or map → odom where there is odometry, with a warning when tf does not
  /// know that of this moment.
  void broadcast(const stillpoint::Pose& map_from_base, const ros::Time& stamp);

 private:
  std::optional<stillpoint::Pose> look_up(const std::string& target, const std::string& source,
                                          const ros::Time& stamp, const ros::Duration& patience);
  void broadcast_world(const Mounting& mounting);

  const Parameters parameters_;
  mutable std::mutex mutex_;
  std::optional<Mounting> mounting_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
};

}  // namespace stillpoint_ros
