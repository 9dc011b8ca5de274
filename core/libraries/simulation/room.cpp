#include "simulation/room.hpp"

#include <cmath>

#include "simulation/furniture.hpp"
#include "simulation/shell.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3f;

constexpr float kLeft = -3.2F;  // metres
constexpr float kRight = 3.2F;
constexpr float kFront = -3.6F;
constexpr float kBack = 4.0F;
constexpr float kHeight = 2.9F;
constexpr float kQuarter = static_cast<float>(M_PI_2);

// Turns of furniture that stands with its back to a wall.
constexpr float kAtBack = 0;
constexpr float kAtLeft = kQuarter;
constexpr float kAtRight = -kQuarter;
constexpr float kAtFront = 2 * kQuarter;

void add_shell(World& world, const ShellSkins& skins) {
  const float width = kRight - kLeft;
  const float depth = kBack - kFront;
  const Vector3f down(0, 0, -kHeight);
  add_panel(world.room, {kLeft, kBack, kHeight}, {width, 0, 0}, down, skins.grey);
  add_panel(world.room, {kRight, kFront, kHeight}, {-width, 0, 0}, down, skins.pale);
  add_panel(world.room, {kLeft, kFront, kHeight}, {0, depth, 0}, down, skins.pale);
  add_panel(world.room, {kRight, kBack, kHeight}, {0, -depth, 0}, down, skins.pale);
  add_panel(world.room, {kLeft, kBack, 0}, {width, 0, 0}, {0, -depth, 0}, skins.floor);
  add_panel(world.room, {kLeft, kFront, kHeight}, {width, 0, 0}, {0, depth, 0}, skins.ceiling);
  for (const float x : {-1.7F, 1.7F})
    for (const float y : {-2.2F, 0.2F, 2.6F}) add_lamp(world, skins.tube, {x, y, kHeight});
}

void add_desks(Furnisher& furnish) {
  constexpr float kTop = 0.731F;  // metres, just above the desks
  furnish.desk({-0.82F, 1.15F}, 1.6F, 0.8F);
  furnish.desk({0.82F, 1.15F}, 1.6F, 0.8F);
  furnish.monitor({-0.62F, 1.35F, kTop, 0.08F}, 0.46F, false);
  furnish.monitor({0.62F, 1.36F, kTop, -0.1F}, 0.62F, true);
  furnish.keyboard({-0.58F, 0.98F, kTop, 0.05F});
  furnish.keyboard({0.62F, 0.96F, kTop, -0.06F});
  furnish.papers({-1.22F, 1.02F, kTop, 0.3F});
  furnish.papers({0.10F, 0.95F, kTop, -0.2F});
  furnish.papers({1.30F, 0.95F, kTop, 0.6F});
  furnish.book_stack({0.03F, 1.28F, kTop, 0.2F}, 4);
  furnish.book_stack({1.33F, 1.30F, kTop, -0.4F}, 6);
  furnish.book_stack({-1.35F, 1.36F, kTop, 0.1F}, 3);
  furnish.mug({-0.18F, 1.05F, kTop});
  furnish.mug({1.02F, 1.08F, kTop, 1.0F});
  furnish.bottle({0.22F, 1.36F, kTop});
  furnish.bottle({-0.98F, 1.40F, kTop});
  furnish.chair({-1.05F, 0.28F, 0, -1.0F});
  furnish.chair({0.98F, 0.22F, 0, 0.9F});
  furnish.cabinet({1.95F, 1.2F}, {0.5F, 0.6F, 0.95F});
  furnish.cardboard_box({1.95F, 1.2F, 0.95F, 0.3F}, {0.35F, 0.28F, 0.22F});
  furnish.cardboard_box({-2.05F, 1.25F, 0, 0.2F}, {0.5F, 0.4F, 0.36F});
  furnish.cardboard_box({-2.05F, 1.25F, 0.36F, -0.1F}, {0.38F, 0.32F, 0.28F});
}

void add_partition(Furnisher& furnish, bool rich) {
  constexpr float kFace = 1.698F;  // metres, y just before the partition
  furnish.partition({0, 1.73F}, 4.6F, 1.45F);
  if (!rich) return;
  furnish.poster({0.08F, kFace, 0.75F}, 0.42F, 0.62F);
  furnish.poster({-1.25F, kFace, 0.80F}, 0.42F, 0.58F);
  furnish.poster({1.35F, kFace, 0.82F}, 0.55F, 0.42F);
  furnish.poster({-1.95F, kFace, 0.70F}, 0.50F, 0.70F);
}

void add_walls(Furnisher& furnish, bool rich) {
  furnish.bookshelf({-2.2F, kBack - 0.16F, 0, kAtBack}, 1.4F, 2.2F);
  furnish.cabinet({-0.4F, kBack - 0.26F, 0, kAtBack}, {1.8F, 0.5F, 1.75F});
  furnish.scaffold({1.9F, kBack - 0.5F, 0, kAtBack}, 1.6F, 2.7F);
  furnish.cardboard_box({-0.8F, kBack - 0.3F, 1.75F, 0.1F}, {0.5F, 0.4F, 0.4F});
  furnish.cardboard_box({0.0F, kBack - 0.3F, 1.75F, -0.2F}, {0.4F, 0.3F, 0.3F});
  furnish.bookshelf({kRight - 0.16F, -1.0F, 0, kAtRight}, 1.8F, 2.2F);
  furnish.sofa({kLeft + 0.45F, -1.9F, 0, kAtLeft});
  furnish.plant({kLeft + 0.4F, -0.4F});
  furnish.plant({kRight - 0.4F, 0.6F});
  furnish.door({kLeft + 1.0F, kFront + 0.04F, 0, kAtFront});
  furnish.desk({1.4F, kFront + 0.42F, 0, kAtFront}, 1.6F, 0.7F);
  furnish.monitor({1.5F, kFront + 0.3F, 0.731F, kAtFront + 0.2F}, 0.5F, true);
  furnish.book_stack({0.95F, kFront + 0.4F, 0.731F, 0.4F}, 5);
  furnish.papers({2.0F, kFront + 0.45F, 0.731F, 0.1F});
  if (!rich) return;
  furnish.whiteboard({0.7F, kBack - 0.04F, 1.85F, kAtBack}, 0.9F, 0.7F);
  furnish.poster({kLeft + 0.005F, 0.7F, 1.0F, kAtLeft}, 0.70F, 1.0F);
  furnish.poster({kLeft + 0.005F, 1.9F, 0.9F, kAtLeft}, 0.84F, 1.18F);
  furnish.poster({kLeft + 0.005F, -1.3F, 1.3F, kAtLeft}, 0.60F, 0.84F);
  furnish.poster({kLeft + 0.005F, -2.3F, 1.25F, kAtLeft}, 0.84F, 0.60F);
  furnish.poster({kRight - 0.005F, 1.7F, 1.0F, kAtRight}, 0.84F, 1.18F);
  furnish.poster({kRight - 0.005F, 0.6F, 1.35F, kAtRight}, 0.60F, 0.84F);
  furnish.whiteboard({kRight - 0.04F, -2.7F, 1.0F, kAtRight}, 1.4F, 1.0F);
  furnish.poster({0.5F, kFront + 0.005F, 1.3F, kAtFront}, 0.60F, 0.84F);
  furnish.poster({1.6F, kFront + 0.005F, 1.4F, kAtFront}, 0.84F, 0.60F);
  furnish.poster({-0.6F, kFront + 0.005F, 1.0F, kAtFront}, 0.70F, 1.0F);
}

}  // namespace

void add_room(World& world, const RoomOptions& options) {
  add_shell(world, shell_skins(world, options));
  if (!options.furnished) return;
  const bool rich = options.walls == RoomOptions::Walls::kRich;
  Furnisher furnish(world, options.seed);
  add_desks(furnish);
  add_partition(furnish, rich);
  add_walls(furnish, rich);
}

}  // namespace stillpoint::simulation
