#include "json_lines.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stillpoint/testing/test_recording.hpp>
#include <string>

namespace {

namespace fs = std::filesystem;
using stillpoint::testing::TestRecording;

const TestRecording& recording() {
  static const TestRecording recording({.frames = 2});
  return recording;
}

/// All that may be known of a frame, which was tracked one metre to the right of the first camera.
stillpoint::FrameReport report() {
  auto segmentation = std::make_shared<stillpoint::Segmentation>();
  segmentation->objects = {{.id = 7, .label = 1, .box = {20, 30, 40, 50}}};
  auto weights = std::make_shared<stillpoint::StaticWeights>();
  weights->object_moves = {true};
  stillpoint::FrameReport report{.frame = recording().frame(1),
                                 .segmentation = segmentation,
                                 .moving = {.points = {{.moving = true}, {}}, .reliable = true},
                                 .weights = weights,
                                 .times = {{.stage = "track", .wall_ms = 4.5, .frame = 1}}};
  report.result.state = stillpoint::TrackState::kTracking;
  report.result.world_from_camera.translation().x() = 1;
  report.result.matches = 120;
  report.result.inliers = 100;
  return report;
}

TEST(JsonLines, WritesALinePerFrame) {
  stillpoint::StageContext context = stillpoint::testing::test_context();
  context.output_directory = ::testing::TempDir();
  const fs::path file = context.output_directory / "json_lines_test.jsonl";
  JsonLines output({.file = file.filename()}, context);
  output.frame({.frame = recording().frame(0)});  // nothing else is known
  output.frame(report());
  std::ifstream stream(file);  // it can be read while the run goes on
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}),
            R"({"frame":0,"time":0.0,"state":"waiting","position":null,"orientation":null,)"
            R"("keyframe":null,"matches":0,"inliers":0,"moving_points":null,"static_share":1.0,)"
            R"("objects":[],"ms":{}})"
            "\n"
            R"({"frame":1,"time":0.033333,"state":"tracking","position":[1.0,0.0,0.0],)"
            R"("orientation":[0.0,0.0,0.0,1.0],"keyframe":null,"matches":120,"inliers":100,)"
            R"("moving_points":1,"static_share":1.0,"objects":[{"class":"person","id":7,)"
            R"("box":[20,30,40,50],"moves":true}],"ms":{"track":4.5}})"
            "\n");
  fs::remove(file);
}

TEST(JsonLines, AnEarlierFileStaysUntilTheFirstFrame) {
  stillpoint::StageContext context = stillpoint::testing::test_context();
  context.output_directory = ::testing::TempDir();
  const fs::path file = context.output_directory / "json_lines_earlier_test.jsonl";
  std::ofstream(file) << "an earlier run\n";
  JsonLines output({.file = file.filename()}, context);
  EXPECT_EQ(fs::file_size(file), 15u);
  output.frame(report());
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line.rfind(R"({"frame":1,)", 0), 0u) << line;
  fs::remove(file);
}

TEST(JsonLines, EndsQuietlyWhenItsReaderGoes) {
  std::signal(SIGPIPE, SIG_IGN);  // as the program does
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  JsonLines output({.file = "/dev/fd/" + std::to_string(ends[1])},
                   stillpoint::testing::test_context());
  output.frame(report());
  ::close(ends[0]);
  EXPECT_NO_THROW(output.frame(report()));
  EXPECT_NO_THROW(output.frame(report()));
  ::close(ends[1]);
}

TEST(JsonLines, AFullDiskIsAnError) {
  JsonLines output({.file = "/dev/full"}, stillpoint::testing::test_context());
  EXPECT_THROW(output.frame(report()), stillpoint::Error);
}

}  // namespace
