// Ctrl-C, and frames in which nothing can be seen.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <tuple>

#include "support/absolute_error.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// The images of the short recording forth and back until a run of it takes long enough.
void list_repeatedly(const RecordingCopy& recording, int images, int frames) {
  std::string colors, depths;
  for (int frame = 0; frame < frames; ++frame) {
    const int phase = frame % (2 * images);
    const int image = phase < images ? phase : 2 * images - 1 - phase;
    const std::string stamp = stamp_text(1000.0 + frame / 30.0);
    colors += stamp + " rgb/" + recording.color(image).filename().string() + "\n";
    depths += stamp + " depth/" + recording.depth(image).filename().string() + "\n";
  }
  recording.write("rgb.txt", colors);
  recording.write("depth.txt", depths);
}

/// In a mode, by a signal: Ctrl-C, or the end of the terminal.
class Interruption : public ::testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(Interruption, LeavesWhatWasComputed) {
  constexpr int kListed = 1000;
  const auto [mode, signal] = GetParam();
  const TemporaryFolder folder;
  const RecordingCopy recording(20);
  list_repeatedly(recording, 20, kListed);
  const fs::path out = folder.path() / "out";
  Program program({"run", "orb_baseline", "--dataset", recording.path().string(), "-o",
                   out.string(), "--set", std::string("runtime.mode=") + mode});
  ASSERT_TRUE(program.wait_for(" key frames  tracking")) << "no line of progress";
  // Shell and kernel both tell the end of a terminal; `timeout` tells process and group.
  for (int i = 0; i < 3; ++i) program.send(signal);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.signal, signal) << outcome.exit_code;
  EXPECT_THAT(outcome.err, HasSubstr("stopped; what was computed until then is saved"));

  const auto summary = json_file(out / "summary.json");
  EXPECT_FALSE(summary["complete"]);
  EXPECT_TRUE(summary["failure"].is_null());
  const auto poses = count_poses(out / "trajectory.txt");
  EXPECT_GT(poses, 0u);
  EXPECT_LT(poses, std::size_t{kListed});
  EXPECT_EQ(summary["tracked_frames"], poses);
  EXPECT_GT(count_poses(out / "keyframes.txt"), 0u);
}

TEST(RunFolder, IsOneRunsAtATime) {
  const TemporaryFolder folder;
  const RecordingCopy recording(20);
  list_repeatedly(recording, 20, 1000);
  const fs::path out = folder.path() / "out";
  const std::vector<std::string> arguments = {
      "run", "orb_baseline", "--dataset", recording.path().string(), "-o", out.string()};
  Program first(arguments);
  ASSERT_TRUE(first.wait_for(" key frames  tracking")) << "no line of progress";
  const Outcome second = call(arguments);
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err,
              HasSubstr(out.string() + ": another run or study is writing into this folder"));
  first.send(SIGINT);
  first.finish();
  EXPECT_GT(count_poses(out / "trajectory.txt"), 0u);
}

// As with `stillpoint run … |& head`.
TEST(ReaderThatGoes, CostsNoResults) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  Program program({"run", "orb_baseline", "--dataset", simulated_recording().string(), "-o",
                   out.string(), "--set", "source.limit=20"});
  program.stop_reading();
  EXPECT_EQ(program.finish().exit_code, 0);
  EXPECT_EQ(count_poses(out / "trajectory.txt"), 20u);
}

INSTANTIATE_TEST_SUITE_P(Modes, Interruption,
                         ::testing::Combine(::testing::Values("inline", "threaded"),
                                            ::testing::Values(SIGINT, SIGHUP)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) +
                                  (std::get<1>(test.param) == SIGHUP ? "_HangUp" : "_CtrlC");
                         });

// Depth stays: without any, a pair counts as unusable and tracking would never see the frame.
class Darkness : public ::testing::Test {
 protected:
  static constexpr int kDark = 10;
  const int kBegin = kSimulatedFrames / 2;

  void SetUp() override {
    for (int frame = kBegin; frame < kBegin + kDark; ++frame)
      recording_.replace(recording_.color(frame), cv::Mat::zeros(480, 640, CV_8UC3));
  }
  nlohmann::json run(const std::string& setting, const std::string& said, double metres) {
    const fs::path out = folder_.path() / "out";
    const Outcome outcome =
        call({"run", "orb_baseline", "--dataset", recording_.path().string(), "-o", out.string(),
              "--set", "runtime.mode=inline", "--set", setting});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(said));
    EXPECT_LT(absolute_error(recording_.path(), out / "trajectory.txt"), metres);
    return json_file(out / "summary.json");
  }

  TemporaryFolder folder_;
  RecordingCopy recording_{kSimulatedFrames};
};

TEST_F(Darkness, IsLostAndFoundAgain) {
  const auto summary = run("tracker.register_depth=false", "lost 1 time\n", 0.006);
  EXPECT_TRUE(summary["complete"]);
  EXPECT_EQ(summary["times_lost"], 1);
  EXPECT_EQ(summary["depth_registered_frames"], 0);
  EXPECT_EQ(summary["frames"], kSimulatedFrames);
  const int tracked = summary["tracked_frames"];
  EXPECT_LE(tracked, kSimulatedFrames - kDark);
  EXPECT_GE(tracked, kSimulatedFrames - kDark - 2);
}

TEST_F(Darkness, RegisteredDepthGivesThePose) {
  const auto summary = run("tracker.register_depth=true", "lost 0 times\n", 0.015);
  EXPECT_EQ(summary["tracked_frames"], kSimulatedFrames);
  EXPECT_GE(summary["depth_registered_frames"], kDark);
}

}  // namespace
}  // namespace stillpoint::testing
