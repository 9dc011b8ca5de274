#include "semantic_octree/cost_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include "semantic_octree/test_map.hpp"
#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::semantic_octree {
namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

// Surfaces of voxels of 5 cm.
std::vector<Eigen::Vector3f> box_surface(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  std::vector<Eigen::Vector3f> points;
  for (double x = low.x(); x <= high.x(); x += 0.05)
    for (double y = low.y(); y <= high.y(); y += 0.05)
      for (double z = low.z(); z <= high.z(); z += 0.05)
        if (x - low.x() < 0.04 || high.x() - x < 0.04 || y - low.y() < 0.04 ||
            high.y() - y < 0.04 || z - low.z() < 0.04 || high.z() - z < 0.04)
          points.emplace_back(Eigen::Vector3d(x, y, z).cast<float>());
  return points;
}

TEST(FloorPlane, OfARoomThatIsTilted) {
  std::vector<Eigen::Vector3f> points = box_surface({-3, -2, -1.2}, {3, 2, 1.3});
  for (const Eigen::Vector3f& p : box_surface({0, 0, -1.2}, {2, 1.5, -0.5})) points.push_back(p);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 0.015F);
  for (const double tilt : {0.0, 20.0, -40.0}) {
    const Eigen::AngleAxisd turn(tilt * M_PI / 180, Eigen::Vector3d(1, 0.5, 0).normalized());
    std::vector<Eigen::Vector3f> turned;
    for (const Eigen::Vector3f& p : points)
      turned.emplace_back((turn * p.cast<double>()).cast<float>() +
                          Eigen::Vector3f(noise(random), noise(random), noise(random)));
    const auto floor = find_floor(turned, kUp, 0.05);
    ASSERT_TRUE(floor);
    EXPECT_LT(std::acos(floor->up.dot(turn * kUp)) * 180 / M_PI, 0.3) << tilt;
    EXPECT_NEAR(floor->height, -1.2, 0.02) << tilt;
  }
}

TEST(FloorPlane, TheLowestSurfaceNotTheLargest) {
  std::vector<Eigen::Vector3f> points;  // a floor of which little was seen, below a large table
  for (double x = 0; x < 3; x += 0.05)
    for (double y = 0; y < 2; y += 0.05) points.emplace_back(x, y, 0.75F);
  for (double x = 0; x < 1; x += 0.05)
    for (double y = 3; y < 5; y += 0.05) points.emplace_back(x, y, 0.0F);
  const auto floor = find_floor(points, kUp, 0.05);
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->height, 0, 0.01);
}

TEST(FloorPlane, SomePointsBelowAreNone) {
  std::vector<Eigen::Vector3f> points = box_surface({-3, -2, 0}, {3, 2, 2.5});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-2, 2);
  for (int i = 0; i < 500; ++i)
    points.emplace_back(place(random), place(random), place(random) - 2);
  const auto floor = find_floor(points, kUp, 0.05);
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->height, 0, 0.02);
}

TEST(FloorPlane, WhereNoneWasSeenThereIsNone) {
  std::vector<Eigen::Vector3f> wall;
  for (double x = 0; x < 3; x += 0.05)
    for (double z = 0; z < 2; z += 0.05) wall.emplace_back(x, 0.0F, z);
  EXPECT_FALSE(find_floor(wall, kUp, 0.05));
  // Four walls that are 3 m long, without floor and ceiling.
  std::vector<Eigen::Vector3f> walls;
  for (const Eigen::Vector3f& p : box_surface({-1.5, -1.5, -1}, {1.5, 1.5, 1}))
    if (std::abs(p.x()) > 1.4F || std::abs(p.y()) > 1.4F) walls.push_back(p);
  EXPECT_FALSE(find_floor(walls, kUp, 0.05));
  EXPECT_FALSE(find_floor_below(walls, kUp, 0.05));
  EXPECT_FALSE(find_floor({}, kUp, 0.05));
  EXPECT_FALSE(find_floor_below({}, kUp, 0.05));
}

class CostMapOfRoom : public ::testing::Test {
 protected:
  static CostMap projected(const TestRoom& room, CostMapOptions options = {}) {
    options.floor = {0, 0, 1};
    const TestMap map(room);
    const auto floor = floor_of(map.tree(), options);
    EXPECT_TRUE(floor);
    EXPECT_NEAR(floor->height, 0.02, 0.03);
    return project(map.tree(), *floor, options);
  }
  static int at(const CostMap& map, double x, double y) {
    const cv::Point cell = map.cell_of({x, y, 1.0});
    if (!cv::Rect({}, map.cells.size()).contains(cell)) return CostMap::kUnknown;
    return map.cells.at<std::uint8_t>(cell);
  }
};

TEST_F(CostMapOfRoom, WallsAndPillarAreInTheWay) {
  const CostMap map = projected({});
  for (double x = -1.8; x < 1.8; x += 0.05)
    for (double y = -2.3; y < 2.3; y += 0.05) {
      const double from_pillar = std::hypot(x - 0.52, y - 1.03);
      const bool behind = y > 1.03, at_its_edge = std::abs(from_pillar - 0.3) < 0.08;
      const bool below_the_camera = std::hypot(x - 0.1, y + 0.4) < 0.4;
      if (behind || at_its_edge || below_the_camera) continue;
      EXPECT_EQ(at(map, x, y), from_pillar > 0.3 ? CostMap::kFree : CostMap::kUnknown)
          << x << ' ' << y;
    }
  EXPECT_EQ(at(map, 0.1, -0.4), CostMap::kUnknown);  // there it never looked down to the floor
  for (double y = -2.2; y < 2.2; y += 0.05) {
    EXPECT_EQ(at(map, 1.93, y), CostMap::kOccupied) << y;
    EXPECT_EQ(at(map, -1.93, y), CostMap::kOccupied) << y;
    EXPECT_EQ(at(map, 2.2, y), CostMap::kUnknown) << y;
  }
  EXPECT_EQ(at(map, 0.44, 0.735), CostMap::kOccupied);
}

TEST_F(CostMapOfRoom, ObstaclesGrowByTheRobot) {
  const CostMap map = projected({}, {.robot_radius = 0.3});
  EXPECT_EQ(at(map, 1.68, -0.4), CostMap::kOccupied);
  EXPECT_EQ(at(map, 1.5, -0.4), CostMap::kFree);
  EXPECT_EQ(at(map, 2.15, -0.4), CostMap::kOccupied);
}

TEST_F(CostMapOfRoom, WhatIsAboveTheRobotIsNoObstacle) {
  // The ceiling is at 2.57 m; of it, little was seen, in the corners.
  const auto obstacles = [](const CostMap& map) {
    return cv::countNonZero(map.cells == CostMap::kOccupied);
  };
  const CostMap below = projected({}, {.to = 2.4}), all = projected({}, {.to = 2.9});
  EXPECT_GT(obstacles(all), obstacles(below) + 10);
  EXPECT_EQ(at(below, -1.4, -0.4), CostMap::kFree);
}

TEST_F(CostMapOfRoom, WithoutFreeSpaceTheFloorIsFree) {
  CostMapOptions options;
  options.floor = {0, 0, 1, 0.02};
  const TestMap map({}, {.carve = false});
  const CostMap cells = project(map.tree(), *floor_of(map.tree(), options), options);
  EXPECT_EQ(at(cells, -1.4, -0.4), CostMap::kFree);
  EXPECT_EQ(at(cells, 1.93, -0.4), CostMap::kOccupied);
}

TEST(CostMap, WhatWasOnlyLookedUnderIsNotFree) {
  SemanticOctree tree(0.05);
  const auto set = [&](double x, double y, double z, bool occupied) {
    tree.updateNode(
        octomap::point3d(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)),
        occupied);
  };
  for (double x = -1; x < 2; x += 0.05)
    for (double y = -1; y < 1; y += 0.05) {
      set(x, y, -0.025, true);
      for (double z = 0.025; z < 1.9; z += 0.05)
        if (x < 1 || z < 0.7) set(x, y, z, false);  // beyond, the upper half is unknown
    }
  CostMapOptions options;
  options.floor = {0, 0, 1, 0};
  const CostMap map = project(tree, *floor_of(tree, options), options);
  EXPECT_EQ(map.cells.at<std::uint8_t>(map.cell_of({0.02, 0.02, 0})), CostMap::kFree);
  EXPECT_EQ(map.cells.at<std::uint8_t>(map.cell_of({1.52, 0.02, 0})), CostMap::kUnknown);
}

// A floor that was looked at from above, and what stands on it; each voxel's log-odds.
SemanticOctree floor_with(const std::function<float(double x, double y, double z)>& things) {
  SemanticOctree tree(0.05);
  for (double x = -0.975; x < 1; x += 0.05)
    for (double y = -0.975; y < 1; y += 0.05)
      for (double z = -0.025; z < 1.9; z += 0.05) {
        const float thing = z < 0 ? 2.0F : things(x, y, z);
        tree.updateNode(
            octomap::point3d(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)),
            thing > 0 ? thing : -0.4F);
      }
  return tree;
}

int cell_at(const SemanticOctree& tree, double x, double y) {
  CostMapOptions options;
  options.floor = {0, 0, 1, 0};
  const CostMap map = project(tree, *floor_of(tree, options), options);
  return map.cells.at<std::uint8_t>(map.cell_of({x, y, 0}));
}

TEST(CostMap, SpecksAreNoObstacles) {
  const SemanticOctree tree = floor_with([](double x, double y, double z) {
    const bool speck = x > 0.5 && x < 0.6 && y > 0 && y < 0.1 && z > 0.5 && z < 0.55;
    const bool bottle = x > -0.6 && x < -0.5 && y > 0 && y < 0.1 && z < 0.3;
    return speck || bottle ? 2.0F : 0.0F;
  });
  EXPECT_EQ(cell_at(tree, 0.525, 0.025), CostMap::kFree);
  EXPECT_EQ(cell_at(tree, -0.525, 0.025), CostMap::kOccupied);
}

TEST(CostMap, WhatWasSeenButOnceIsNotKnown) {
  constexpr float kOnce = 0.62F;
  const SemanticOctree tree = floor_with([](double x, double y, double z) {
    const bool post = x > 0.5 && x < 0.6 && y > 0 && y < 0.1 && z < 1;
    const bool cupboard = x < -0.5 && y > 0;
    return post || (cupboard && z < 1) ? kOnce : cupboard ? 2 * kOnce : 0.0F;
  });
  EXPECT_EQ(cell_at(tree, 0.525, 0.025), CostMap::kUnknown);
  EXPECT_EQ(cell_at(tree, -0.525, 0.025), CostMap::kOccupied);
  const SemanticOctree seen_again = floor_with([](double x, double y, double z) {
    return x > 0.5 && x < 0.6 && y > 0 && y < 0.1 && z < 1 ? 2 * kOnce : 0.0F;
  });
  EXPECT_EQ(cell_at(seen_again, 0.525, 0.025), CostMap::kOccupied);
}

TEST_F(CostMapOfRoom, FilesForMapServer) {
  const testing::TemporaryFolder folder;
  const CostMap map = projected({});
  write_cost_map(map, folder.path() / "room");
  std::ifstream image(folder.path() / "room.pgm", std::ios::binary);
  const std::string pgm(std::istreambuf_iterator<char>(image), {});
  const std::string header =
      "P5\n" + std::to_string(map.cells.cols) + ' ' + std::to_string(map.cells.rows) + "\n255\n";
  ASSERT_TRUE(pgm.starts_with(header));
  ASSERT_EQ(pgm.size(), header.size() + map.cells.total());
  // The first row is the one of largest y: below the wall at y = 2.41 in the world's frame, whose
  // z axis, along which no direction on the floor lies, leaves x to be x.
  EXPECT_EQ(map.cell_of({0, -5, 0}).y - map.cell_of({0, 5, 0}).y, 200);
  std::ifstream description(folder.path() / "room.yaml");
  const std::string yaml(std::istreambuf_iterator<char>(description), {});
  EXPECT_THAT(yaml, ::testing::HasSubstr("image: \"room.pgm\"\n"));
  EXPECT_THAT(yaml, ::testing::HasSubstr("resolution: 0.05\n"));
  EXPECT_THAT(yaml, ::testing::ContainsRegex("origin: \\[-[0-9.]+, -[0-9.]+, 0\\]\n"));
  EXPECT_THAT(yaml, ::testing::HasSubstr("occupied_thresh: 0.65\nfree_thresh: 0.196\n"));
}

TEST_F(CostMapOfRoom, AFolderThatCannotBeMadeIsAnError) {
  EXPECT_THROW(write_cost_map(projected({}), "/proc/no_such_folder/room"), Error);
}

}  // namespace
}  // namespace stillpoint::semantic_octree
