#include "output_mcap/mcap_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "stillpoint/testing/test_recording.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::output_mcap {
namespace {

namespace fs = std::filesystem;
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

}  // namespace
}  // namespace stillpoint::output_mcap
