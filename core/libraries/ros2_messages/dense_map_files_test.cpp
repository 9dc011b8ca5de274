#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "ros2_messages/cost_map_file.hpp"
#include "ros2_messages/octree_file.hpp"
#include "stillpoint/error.hpp"
#include "support/error_text.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::ros2_messages {
namespace {

using testing::error_text;
using ::testing::HasSubstr;

class DenseMapFiles : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
};

TEST_F(DenseMapFiles, ACostMapIsReadWithItsPlaceInTheWorld) {
  cv::Mat image(2, 3, CV_8UC1, cv::Scalar(205));
  image.at<std::uint8_t>(0, 0) = 0;    // upper left: occupied
  image.at<std::uint8_t>(1, 2) = 254;  // lower right: free
  testing::write_image((folder_.path() / "map.pgm").string(), image);
  folder_.write("map.yaml",
                "image: \"map.pgm\"\nmode: trinary\nresolution: 0.05\norigin: [-1, 2, 0]\n"
                "world_from_map: [0, 1.5, 0, 0.5, -0.5, 0.5, 0.5]\n");
  const auto grid = read_cost_map(folder_.path());
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->resolution, 0.05);
  const cv::Mat expected = (cv::Mat_<std::int8_t>(2, 3) << -1, -1, 0, 100, -1, -1);
  EXPECT_EQ(cv::norm(grid->cells, expected, cv::NORM_INF), 0);
  // x of the floor is z of the world, y is -x, z is -y.
  EXPECT_LT((grid->header_from_origin.translation() - Eigen::Vector3d(-2, 1.5, -1)).norm(), 1e-9);
}

TEST_F(DenseMapFiles, WithoutACostMapThereIsNone) {
  EXPECT_FALSE(read_cost_map(folder_.path()));
  EXPECT_FALSE(read_cost_map({}));
}

TEST_F(DenseMapFiles, ABrokenCostMapIsNamed) {
  for (const char* yaml : {"image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"
                           "world_from_map: [0, 0, 0, 0, 0, 0, 1]\n",  // no such image
                           "resolution: [\n", "resolution: 0.05\n"}) {
    folder_.write("map.yaml", yaml);
    try {
      read_cost_map(folder_.path());
      FAIL() << yaml;
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::kData);
      EXPECT_THAT(error.what(), HasSubstr("map.yaml: cannot read the cost map"));
    }
  }
}

TEST_F(DenseMapFiles, AnOctreeIsWhatFollowsItsHeader) {
  folder_.write("map.bt", "# Octomap OcTree binary file\nid OcTree\nsize 3\nres 0.05\ndata\nabc");
  const auto octree = read_octree_message(folder_.path());
  ASSERT_TRUE(octree);
  EXPECT_EQ(octree->resolution, 0.05);
  EXPECT_EQ(octree->nodes, (Bytes{'a', 'b', 'c'}));
  EXPECT_FALSE(read_octree_message({}));
}

TEST_F(DenseMapFiles, ABrokenOctreeIsNamed) {
  folder_.write("map.bt", "# Octomap OcTree binary file\ndata\nabc");
  EXPECT_THAT(error_text(Fault::kData, [&] { read_octree_message(folder_.path()); }),
              HasSubstr("map.bt: is no .bt file"));
}

}  // namespace
}  // namespace stillpoint::ros2_messages
