// Light on what does not move, computed once: lamps with soft shadows, and darker corners.
#pragma once

#include "simulation/world.hpp"

namespace stillpoint::simulation {

/// Sets the light at the corners of the room's faces.
void light_room(World& world);

/// Light on a body with this normal (world frame), without shadows.
float light_on_body(const Eigen::Vector3f& normal);

}  // namespace stillpoint::simulation
