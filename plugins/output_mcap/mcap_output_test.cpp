#include "output_mcap/mcap_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>

#include "output_mcap/cost_map_file.hpp"
#include "stillpoint/testing/test_recording.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::output_mcap {
namespace {

namespace fs = std::filesystem;
using mcap_writer::OccupancyGrid;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class McapOutputTest : public ::testing::Test {
 protected:
  McapOutputTest() { context_.output_directory = folder_.path(); }

  std::string text() const {
    std::ifstream stream(folder_.path() / "run.mcap", std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  RunSummary summary() const {
    return {.map = map_, .poses = poses_, .source = source_, .times = times_};
  }

  TemporaryFolder folder_;
  StageContext context_;
  SparseMap map_;
  std::vector<TrackedPose> poses_;
  SourceReport source_;
  std::vector<StageTime> times_;
};

FrameReport report_at(double time, TrackState state) {
  FrameReport report;
  report.frame = std::make_shared<const Frame>(Frame{.time = time});
  report.result.state = state;
  return report;
}

/// Occurrences in a file without compression.
std::size_t count(const std::string& text, std::string_view word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    ++found;
  return found;
}

TEST_F(McapOutputTest, LostFramesHaveAStateAndNoPose) {
  McapOutput output({.compression = Compression::kNone}, context_);
  output.frame(report_at(1, TrackState::kWaiting));
  output.frame(report_at(2, TrackState::kTracking));
  output.frame(report_at(3, TrackState::kLost));
  output.finish(summary());
  EXPECT_EQ(count(text(), "waiting"), 1u);
  EXPECT_EQ(count(text(), "tracking"),
            1u + 2 * 1);  // "/tracking_state" in the chunk and the summary
  EXPECT_EQ(count(text(), "LOST"), 1u);
  EXPECT_EQ(count(text(), "camera_color_optical_frame"), 2u);  // tf and odometry
}

TEST_F(McapOutputTest, ARunWithoutFramesGivesAFileWithoutMessages) {
  McapOutput({}, context_).finish(summary());
  EXPECT_TRUE(text().starts_with("\x89MCAP0\r\n"));
  EXPECT_TRUE(text().ends_with("\x89MCAP0\r\n"));
}

TEST_F(McapOutputTest, AFullDiskIsToldOnce) {
  fs::create_symlink("/dev/full", folder_.path() / "run.mcap");
  McapOutput output({}, context_);
  output.frame(report_at(1, TrackState::kTracking));
  try {
    output.finish(summary());
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("run.mcap: cannot write: No space left on device"));
  }
  EXPECT_NO_THROW(output.frame(report_at(2, TrackState::kTracking)));
}

TEST_F(McapOutputTest, ACostMapIsReadWithItsPlaceInTheWorld) {
  cv::Mat image(2, 3, CV_8UC1, cv::Scalar(205));
  image.at<std::uint8_t>(0, 0) = 0;    // upper left: occupied
  image.at<std::uint8_t>(1, 2) = 254;  // lower right: free
  cv::imwrite((folder_.path() / "map.pgm").string(), image);
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

TEST_F(McapOutputTest, ADamagedOctreeIsNamed) {
  folder_.write("map.ot", "# Octomap OcTree file\nid ColorOcTree\nsize 7\nres 0.05\ndata\n");
  poses_.push_back({.time = 1});
  McapOutput output({}, context_);
  RunSummary run = summary();
  run.map_directory = folder_.path();
  try {
    output.finish(run);
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kData);
    EXPECT_THAT(error.what(), HasSubstr("map.ot"));
  }
}

TEST_F(McapOutputTest, WithoutACostMapThereIsNone) {
  EXPECT_FALSE(read_cost_map(folder_.path()));
  EXPECT_FALSE(read_cost_map({}));
}

TEST_F(McapOutputTest, ABrokenCostMapIsNamed) {
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

}  // namespace
}  // namespace stillpoint::output_mcap
