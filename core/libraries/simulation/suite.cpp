#include "simulation/suite.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "simulation/furniture.hpp"
#include "simulation/shell.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Affine3f;
using Eigen::Translation3f;
using Eigen::Vector3f;

constexpr int kColumns = 2;
constexpr int kRows = 5;
constexpr float kSize = 6.0F;  // metres, of a room
constexpr float kHeight = 2.9F;
constexpr float kWall = 0.12F;  // thickness
constexpr float kDoorWidth = 1.5F;
constexpr float kDoorHeight = 2.2F;
constexpr float kDoorAside = 1.2F;
constexpr int kSides = 4;  // of a room: back (+y), left, front, right

Affine3f turned(float angle) { return Affine3f(Eigen::AngleAxisf(angle, Vector3f::UnitZ())); }

Vector3f centre(int column, int row) {
  return {kSize * (static_cast<float>(column) - 0.5F * (kColumns - 1)),
          kSize * (static_cast<float>(row) - 0.5F * (kRows - 1)), 0};
}

/// From the axes of a wall, seen from inside: x along it, y into it, from the middle of its foot.
Affine3f room_from_side(int side) {
  return turned(static_cast<float>(M_PI_2) * static_cast<float>(side)) *
         Translation3f(0, (kSize - kWall) / 2, 0);
}

float aside(int row) { return row % 2 == 0 ? -kDoorAside : kDoorAside; }

/// Where along a wall of a room its doorway is.
std::optional<float> doorway(int column, int row, int side) {
  const bool at_end = row == 0 || row == kRows - 1;
  if (side == 0 && row < kRows - 1) return aside(row);
  if (side == 2 && row > 0) return -aside(row - 1);
  if (side == (column == 0 ? 3 : 1) && at_end) return 0.0F;
  return std::nullopt;
}

/// A piece of a wall from `low` to `high` along it, seen from both sides.
void add_wall(World& world, const Affine3f& wall, float low, float high, float foot,
              const Skin& skin) {
  add_box(world.room, wall * Translation3f((low + high) / 2, kWall / 2, (foot + kHeight) / 2),
          {high - low, kWall, kHeight - foot}, skin);
}

void add_wall_with_doorway(World& world, const Affine3f& wall, std::optional<float> door,
                           const Skin& skin) {
  const float end = kSize / 2;
  if (!door) {
    add_wall(world, wall, -end, end, 0, skin);
    return;
  }
  const float low = *door - kDoorWidth / 2;
  const float high = *door + kDoorWidth / 2;
  add_wall(world, wall, -end, low, 0, skin);
  add_wall(world, wall, high, end, 0, skin);
  add_wall(world, wall, low, high, kDoorHeight, skin);
}

void add_shell(World& world, const ShellSkins& skins) {
  constexpr float kWidth = kColumns * kSize;
  constexpr float kDepth = kRows * kSize;
  const Vector3f corner(-kWidth / 2, -kDepth / 2, 0);
  add_panel(world.room, corner + Vector3f(0, kDepth, 0), {kWidth, 0, 0}, {0, -kDepth, 0},
            skins.floor);
  add_panel(world.room, corner + Vector3f(0, 0, kHeight), {kWidth, 0, 0}, {0, kDepth, 0},
            skins.ceiling);
  for (int column = 0; column < kColumns; ++column)
    for (int row = 0; row < kRows; ++row) {
      const Vector3f middle = centre(column, row);
      for (const float x : {-1.5F, 1.5F})
        add_lamp(world, skins.tube, middle + Vector3f(x, 0, kHeight));
      for (int side = 0; side < kSides; ++side) {
        // Two rooms share a wall: that of the first, or of the outside.
        const bool shared = (side == 2 && row > 0) || (side == 1 && column > 0);
        if (!shared)
          add_wall_with_doorway(world, Translation3f(middle) * room_from_side(side),
                                doorway(column, row, side),
                                (row + side) % 2 == 0 ? skins.pale : skins.grey);
      }
    }
}

/// Something to stand or hang before a wall; `put` gets its middle along the wall.
struct Piece {
  float width;  // metres
  void (*put)(Furnisher& furnish, float x, bool rich);
};

void put_desk(Furnisher& furnish, float x, bool rich) {
  constexpr float kTop = 0.731F;  // metres, just above the desk
  furnish.desk({x, -0.38F}, 1.6F, 0.7F);
  furnish.monitor({x - 0.2F, -0.25F, kTop, 0.1F}, 0.5F, true);
  furnish.keyboard({x - 0.2F, -0.55F, kTop, 0.05F});
  furnish.book_stack({x + 0.5F, -0.28F, kTop, 0.3F}, 4);
  furnish.papers({x + 0.45F, -0.52F, kTop, -0.2F});
  furnish.chair({x - 0.1F, -1.0F, 0, static_cast<float>(M_PI) - 0.4F});
  if (rich) furnish.poster({x, -0.005F, 1.5F}, 0.9F, 0.6F);
}

void put_sofa(Furnisher& furnish, float x, bool rich) {
  furnish.sofa({x, -0.43F});
  if (rich) furnish.poster({x, -0.005F, 1.2F}, 0.84F, 0.6F);
}

void put_cabinet(Furnisher& furnish, float x, bool rich) {
  furnish.cabinet({x, -0.26F}, {1.2F, 0.5F, 1.05F});
  furnish.cardboard_box({x - 0.3F, -0.26F, 1.05F, 0.2F}, {0.4F, 0.3F, 0.3F});
  furnish.bottle({x + 0.35F, -0.25F, 1.05F});
  if (rich) furnish.poster({x + 0.2F, -0.005F, 1.5F}, 0.6F, 0.84F);
}

void put_boxes(Furnisher& furnish, float x, bool /*rich*/) {
  furnish.cardboard_box({x, -0.3F, 0, 0.1F}, {0.6F, 0.45F, 0.42F});
  furnish.cardboard_box({x, -0.3F, 0.42F, -0.2F}, {0.5F, 0.4F, 0.36F});
  furnish.cardboard_box({x, -0.3F, 0.78F, 0.3F}, {0.38F, 0.32F, 0.28F});
}

void put_pictures(Furnisher& furnish, float x, bool rich) {
  if (!rich) return;
  furnish.poster({x - 0.42F, -0.005F, 0.9F}, 0.7F, 1.0F);
  furnish.poster({x + 0.42F, -0.005F, 1.1F}, 0.6F, 0.84F);
}

void put_whiteboard(Furnisher& furnish, float x, bool rich) {
  if (rich) furnish.whiteboard({x, -0.04F, 0.95F}, 1.4F, 1.0F);
}

constexpr std::array<Piece, 8> kPieces = {{
    {1.6F, put_desk},
    {1.5F,
     [](Furnisher& furnish, float x, bool) {
       furnish.bookshelf({x, -0.16F}, 1.4F, 2.2F);
     }},
    {1.8F, put_sofa},
    {1.3F, put_cabinet},
    {0.7F, put_boxes},
    {1.7F, put_pictures},
    {1.6F, put_whiteboard},
    {0.7F,
     [](Furnisher& furnish, float x, bool) {
       furnish.plant({x, -0.4F});
     }},
}};

/// One piece after the other; what would stand in the doorway is left out.
void furnish_wall(Furnisher& furnish, cv::RNG& random, std::optional<float> door, bool rich) {
  constexpr float kReach = 2.1F;  // metres; corners belong to neither wall
  constexpr float kGap = 0.15F;
  for (float x = -kReach;;) {
    const Piece& piece =
        kPieces[static_cast<std::size_t>(random.uniform(0, static_cast<int>(kPieces.size())))];
    if (x + piece.width > kReach) return;
    const float middle = x + piece.width / 2;
    if (!door || std::abs(middle - *door) > (piece.width + kDoorWidth) / 2)
      piece.put(furnish, middle, rich);
    x += piece.width + kGap;
  }
}

void furnish_room(World& world, const RoomOptions& options, int column, int row) {
  const int seed = options.seed + (options.alike ? 0 : 1000 * (1 + column * kRows + row));
  const Translation3f place(centre(column, row));
  Furnisher furnish(world, seed);
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  for (int side = 0; side < kSides; ++side) {
    furnish.move_origin(place * room_from_side(side));
    furnish_wall(furnish, random, doorway(column, row, side),
                 options.walls == RoomOptions::Walls::kRich);
  }
}

}  // namespace

void add_suite(World& world, const RoomOptions& options) {
  add_shell(world, shell_skins(world, options));
  if (!options.furnished) return;
  for (int column = 0; column < kColumns; ++column)
    for (int row = 0; row < kRows; ++row) furnish_room(world, options, column, row);
}

}  // namespace stillpoint::simulation
