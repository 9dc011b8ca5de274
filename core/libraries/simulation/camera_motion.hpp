// How the camera moves: the handheld motions of the TUM benchmark as smooth functions of time.
#pragma once

#include <optional>

#include "simulation/scene_options.hpp"
#include "simulation/walking_path.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::simulation {

class CameraMotion {
 public:
  CameraMotion(const MotionOptions& options, int seed);

  /// `time` in seconds from the first frame.
  Pose world_from_camera(double time) const;

 private:
  Pose wanted(double time) const;
  Pose trembling(double time) const;

  MotionOptions options_;
  std::optional<WalkingPath> path_;
  int seed_;
};

}  // namespace stillpoint::simulation
