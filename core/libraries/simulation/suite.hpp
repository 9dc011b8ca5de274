// Ten rooms in two columns of five, joined by doorways into a ring: for long loops.
#pragma once

#include "simulation/scene_options.hpp"
#include "simulation/world.hpp"

namespace stillpoint::simulation {

/// Rooms are squares of 6 m, the suite's centre is the origin. Doorways between the rooms of a
/// column lie 1.2 m left and right of their middle in turn; both columns meet at either end.
void add_suite(World& world, const RoomOptions& options);

}  // namespace stillpoint::simulation
