// The room: walls, floor, ceiling with lamps, and an office's furniture.
#pragma once

#include "simulation/scene_options.hpp"
#include "simulation/world.hpp"

namespace stillpoint::simulation {

void add_room(World& world, const RoomOptions& options);

}  // namespace stillpoint::simulation
