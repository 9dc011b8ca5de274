// The camera at one moment of an exposure.
#pragma once

#include <Eigen/Core>

#include "simulation/camera_motion.hpp"

namespace stillpoint::simulation {

struct Eye {
  Eigen::Vector3f position;           ///< metres, world
  Eigen::Matrix3f world_from_camera;  ///< rotation
  float moment = 0.5F;                ///< of the exposure, [0, 1]

  Eigen::Vector3f in_camera(const Eigen::Vector3f& point_in_world) const {
    return world_from_camera.transpose() * (point_in_world - position);
  }
};

/// Times in seconds; `time` is the middle of the exposure.
inline Eye eye_at(const CameraMotion& motion, double time, double exposure, double moment) {
  const Pose pose = motion.world_from_camera(time + (moment - 0.5) * exposure);
  return {pose.translation().cast<float>(), pose.linear().cast<float>(),
          static_cast<float>(moment)};
}

}  // namespace stillpoint::simulation
