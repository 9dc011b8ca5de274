// A ball thrown to and fro.
#pragma once

#include "simulation/scene_options.hpp"
#include "simulation/world.hpp"

namespace stillpoint::simulation {

/// Centre of the ball; free fall while it flies. `time` in seconds from the first frame.
Eigen::Vector3d ball_position(const BallOptions& options, double time);

void add_ball(World& world, const BallOptions& options);

}  // namespace stillpoint::simulation
