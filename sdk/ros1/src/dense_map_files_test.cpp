#include "dense_map_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stillpoint/error.hpp>
#include <stillpoint/support/temporary_folder.hpp>

namespace stillpoint_ros {
namespace {

using stillpoint::Error;
using stillpoint::Pose;

class DenseMapFiles : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = folder_.path() / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  const stillpoint::TemporaryFolder folder_;
};

const char* const kDescription =
    "image: \"map.pgm\"\nresolution: 0.5\norigin: [1, 2, 0]\nworld_from_map: [0, 0, 3, 0, 0, 0, "
    "1]\n";

TEST_F(DenseMapFiles, AGridBeginsAtTheLowestRow) {
  write("map.pgm", std::string("P5\n2 2\n255\n") + '\xfe' + '\xcd' + '\0' + '\xfe');
  Pose map_from_world = Pose::Identity();
  map_from_world.translation() = Eigen::Vector3d(10, 0, 0);
  const nav_msgs::OccupancyGrid grid =
      grid_message(write("map.yaml", kDescription), map_from_world);
  EXPECT_EQ(grid.data, (std::vector<std::int8_t>{100, 0, 0, -1}));
  EXPECT_EQ(grid.info.width, 2u);
  EXPECT_EQ(grid.info.resolution, 0.5f);
  EXPECT_EQ(grid.info.origin.position.x, 11);
  EXPECT_EQ(grid.info.origin.position.y, 2);
  EXPECT_EQ(grid.info.origin.position.z, 3);
}

TEST_F(DenseMapFiles, WhatIsNoGridIsRefused) {
  EXPECT_THROW(grid_message(write("missing_image.yaml", kDescription), Pose::Identity()), Error);
  EXPECT_THROW(grid_message("/no/such/file", Pose::Identity()), Error);
  EXPECT_THROW(grid_message(write("empty.yaml", "image: 7\n"), Pose::Identity()), Error);
  write("map.pgm", std::string("P5\n1 1\n255\n") + '\xfe');
  EXPECT_THROW(grid_message(write("short.yaml",
                                  "image: map.pgm\nresolution: 1\norigin: [1]\n"
                                  "world_from_map: [1, 2]\n"),
                            Pose::Identity()),
               Error);
}

TEST_F(DenseMapFiles, AnOctomapIsWhatFollowsItsHeader) {
  const std::string header =
      "# Octomap OcTree binary file\nid ColorOcTree\nsize 1\nres 0.05\ndata\n";
  const octomap_msgs::Octomap octomap = octomap_message(write("map.bt", header + "\x01\n\x02"));
  EXPECT_TRUE(octomap.binary);
  EXPECT_EQ(octomap.id, "OcTree");
  EXPECT_EQ(octomap.resolution, 0.05);
  EXPECT_EQ(octomap.data, (std::vector<std::int8_t>{1, '\n', 2}));
  EXPECT_THROW(octomap_message(write("none.bt", "data\nabc")), Error);
  EXPECT_THROW(octomap_message("/no/such/file"), Error);
}

}  // namespace
}  // namespace stillpoint_ros
