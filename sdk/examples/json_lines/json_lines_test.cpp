#include "json_lines.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stillpoint/testing/test_recording.hpp>
#include <vector>

namespace {

namespace fs = std::filesystem;
using stillpoint::testing::TestRecording;

const TestRecording& recording() {
  static const TestRecording recording({.frames = 2});
  return recording;
}

/// All that is known of frame i, which was tracked one metre to the right of the first camera.
stillpoint::FrameReport report(std::size_t i) {
  stillpoint::FrameReport report{.frame = recording().frame(i),
                                 .segmentation = recording().segmentation(i),
                                 .moving = recording().moving_points(i),
                                 .weights = recording().weights(i),
                                 .times = {{.stage = "track", .wall_ms = 4.5, .frame = 1}}};
  report.result.state = stillpoint::TrackState::kTracking;
  report.result.world_from_camera.translation().x() = 1;
  return report;
}

TEST(JsonLines, WritesAnObjectPerLine) {
  stillpoint::StageContext context = stillpoint::testing::test_context();
  context.output_directory = ::testing::TempDir();
  const fs::path file = context.output_directory / "json_lines_test.jsonl";
  JsonLines output({.file = file.filename()}, context);
  output.frame({.frame = recording().frame(0)});  // nothing else is known
  output.frame(report(1));

  std::ifstream stream(file);  // it can be read while the run goes on
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0]["state"], "waiting");
  EXPECT_TRUE(lines[0]["position"].is_null());
  EXPECT_TRUE(lines[0]["objects"].empty());
  EXPECT_EQ(lines[1]["frame"], 1);
  EXPECT_EQ(lines[1]["position"], nlohmann::json({1, 0, 0}));
  EXPECT_EQ(lines[1]["orientation"], nlohmann::json({0, 0, 0, 1}));
  EXPECT_EQ(lines[1]["objects"][0]["class"], "person");
  EXPECT_EQ(lines[1]["objects"][0]["moves"], true);
  EXPECT_EQ(lines[1]["ms"]["track"], 4.5);
  fs::remove(file);
}

TEST(JsonLines, EndsQuietlyWhenItsReaderGoes) {
  std::signal(SIGPIPE, SIG_IGN);  // as the program does
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  JsonLines output({.file = "/dev/fd/" + std::to_string(ends[1])},
                   stillpoint::testing::test_context());
  output.frame(report(0));
  ::close(ends[0]);
  EXPECT_NO_THROW(output.frame(report(1)));
  EXPECT_NO_THROW(output.frame(report(1)));
  ::close(ends[1]);
}

TEST(JsonLines, AFullDiskIsAnError) {
  JsonLines output({.file = "/dev/full"}, stillpoint::testing::test_context());
  EXPECT_THROW(output.frame(report(0)), stillpoint::Error);
}

}  // namespace
