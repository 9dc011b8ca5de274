// A corridor along +y with nothing in it but what stands at its beginning: where a camera has
// little to hold on to.
#pragma once

#include "simulation/world.hpp"

namespace stillpoint::simulation {

/// From y = -1 to 15 m, x = -1 to 1 m, lit evenly. Furnished, there are pictures and boxes up to
/// y = 3 m, whatever `walls` says.
void add_corridor(World& world, const RoomOptions& options);

}  // namespace stillpoint::simulation
