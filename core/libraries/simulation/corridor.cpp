#include "simulation/corridor.hpp"

#include <cmath>

#include "simulation/furniture.hpp"
#include "simulation/shell.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3f;

constexpr float kLeft = -1.0F;  // metres
constexpr float kRight = 1.0F;
constexpr float kFront = -1.0F;
constexpr float kBack = 15.0F;
constexpr float kHeight = 2.7F;
constexpr float kCell = 2.0F;  // metres; in smaller ones the baked light would be a texture
constexpr float kAtLeft = static_cast<float>(M_PI_2);  // turns of what hangs on a side wall
constexpr float kAtRight = -kAtLeft;

void add_beginning(Furnisher& furnish) {
  furnish.poster({kLeft + 0.005F, 1.4F, 1.0F, kAtLeft}, 0.60F, 0.84F);
  furnish.poster({kLeft + 0.005F, 2.3F, 0.9F, kAtLeft}, 0.70F, 1.0F);
  furnish.poster({kRight - 0.005F, 1.8F, 1.0F, kAtRight}, 0.84F, 1.18F);
  furnish.cardboard_box({-0.75F, 2.4F, 0, 0.2F}, {0.38F, 0.32F, 0.28F});
  furnish.cardboard_box({0.75F, 2.8F, 0, -0.1F}, {0.35F, 0.30F, 0.36F});
}

}  // namespace

void add_corridor(World& world, const RoomOptions& options) {
  const ShellSkins skins = shell_skins(world, options);
  const float width = kRight - kLeft, length = kBack - kFront;
  const Vector3f down(0, 0, -kHeight);
  add_panel(world.room, {kLeft, kBack, kHeight}, {width, 0, 0}, down, skins.grey, kCell);
  add_panel(world.room, {kRight, kFront, kHeight}, {-width, 0, 0}, down, skins.pale, kCell);
  add_panel(world.room, {kLeft, kFront, kHeight}, {0, length, 0}, down, skins.pale, kCell);
  add_panel(world.room, {kRight, kBack, kHeight}, {0, -length, 0}, down, skins.pale, kCell);
  add_panel(world.room, {kLeft, kBack, 0}, {width, 0, 0}, {0, -length, 0}, skins.floor, kCell);
  add_panel(world.room, {kLeft, kFront, kHeight}, {width, 0, 0}, {0, length, 0}, skins.ceiling,
            kCell);
  if (!options.furnished) return;
  Furnisher furnish(world, options.seed);
  add_beginning(furnish);
}

}  // namespace stillpoint::simulation
