#include "simulation/body_tiles.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stillpoint::simulation {
namespace {

using Eigen::AlignedBox3f;
using Eigen::Vector3f;

constexpr int kWidth = 4;  // px, of a tile
constexpr int kHeight = 2;

Camera camera() { return {.width = 64, .height = 48, .fx = 50, .fy = 50, .cx = 31.5, .cy = 23.5}; }

int marked(const BodyTiles& tiles) {
  int count = 0;
  for (int row = 0; row < 24; ++row)
    for (int column = 0; column < 16; ++column) count += tiles.at(column, row);
  return count;
}

/// Two moments; camera and body move in between.
struct Moving {
  std::array<Eye, 2> eyes{Eye{Vector3f::Zero(), Eigen::Matrix3f::Identity(), 0},
                          Eye{Vector3f::Zero(), Eigen::Matrix3f::Identity(), 1}};
  std::array<Eigen::Affine3f, 2> world_from_body{Eigen::Affine3f::Identity(),
                                                 Eigen::Affine3f::Identity()};

  BodyTiles tiles(const AlignedBox3f& box) const {
    BodyTiles result(camera(), kWidth, kHeight);
    result.add(box, world_from_body, eyes);
    return result;
  }
};

TEST(BodyTiles, NothingOfABodyIsSeenElsewhere) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(-1, 1);
  const auto point = [&] { return Vector3f(any(random), any(random), any(random)); };
  int seen = 0;
  for (int i = 0; i < 200; ++i) {
    AlignedBox3f box(0.3F * point());
    box.extend(0.3F * point());
    Moving moving;
    moving.world_from_body[0].translation() = Vector3f(0, 0, 2) + point();
    moving.world_from_body[1].translation() =
        moving.world_from_body[0].translation() + 0.02F * point();
    moving.eyes[1].position = 0.02F * point();
    const BodyTiles tiles = moving.tiles(box);
    for (int k = 0; k < 100; ++k) {
      const Vector3f in_body = box.sample();
      const float moment = 0.5F + 0.5F * any(random);
      const Vector3f p = (1 - moment) * (moving.world_from_body[0] * in_body) +
                         moment * (moving.world_from_body[1] * in_body) -
                         moment * moving.eyes[1].position;
      const int x = static_cast<int>(std::lround(50 * p.x() / p.z() + 31.5F));
      const int y = static_cast<int>(std::lround(50 * p.y() / p.z() + 23.5F));
      if (x < 0 || y < 0 || x >= 64 || y >= 48) continue;
      ++seen;
      ASSERT_TRUE(tiles.at(x / kWidth, y / kHeight)) << x << ' ' << y;
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST(BodyTiles, FewTilesForASmallBody) {
  Moving moving;
  for (Eigen::Affine3f& pose : moving.world_from_body) pose.translation().z() = 2;
  const int count = marked(moving.tiles({Vector3f::Constant(-0.04F), Vector3f::Constant(0.04F)}));
  EXPECT_GE(count, 4);
  EXPECT_LE(count, 20);  // 2 px, and a margin of a tile on each side
}

TEST(BodyTiles, WhatIsBehindIsNotSeenAndWhatIsHereIsEverywhere) {
  Moving moving;
  EXPECT_EQ(marked(moving.tiles({Vector3f(-1, -1, -3), Vector3f(1, 1, -1)})), 0);
  EXPECT_EQ(marked(moving.tiles({Vector3f(-1, -1, -1), Vector3f(1, 1, 1)})), 16 * 24);
  EXPECT_EQ(marked(moving.tiles({Vector3f(50, -1, 1), Vector3f(60, 1, 3)})), 0);
}

}  // namespace
}  // namespace stillpoint::simulation
