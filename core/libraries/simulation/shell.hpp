// What rooms are built of, and the lamps under their ceilings.
#pragma once

#include "simulation/world.hpp"

namespace stillpoint::simulation {

struct ShellSkins {
  Skin floor;
  Skin ceiling;
  Skin pale;  ///< walls
  Skin grey;  ///< walls
  Skin tube;  ///< lamps
};

ShellSkins shell_skins(World& world, const RoomOptions& options);

/// A tube of 1.2 m along y under the ceiling at `place`.
void add_lamp(World& world, const Skin& tube, const Eigen::Vector3f& place);

}  // namespace stillpoint::simulation
