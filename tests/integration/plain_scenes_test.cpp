// Where there is little texture, or none: depth registration gives the pose, in both modes.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/absolute_error.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;

class PlainScenes : public ::testing::TestWithParam<const char*> {
 protected:
  nlohmann::json run(const fs::path& recording) {
    const Outcome outcome =
        call({"run", "orb_baseline", "--dataset", recording.string(), "-o", out().string(), "--set",
              std::string("runtime.mode=") + GetParam()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return json_file(out() / "summary.json");
  }
  fs::path out() const { return folder_.path() / "run"; }

  TemporaryFolder folder_;
};

TEST_P(PlainScenes, ACornerIsTrackedToTheEnd) {
  const fs::path recording = recording_of("plain_corner");
  const auto summary = run(recording);
  EXPECT_EQ(summary["tracked_frames"], kSimulatedFrames);
  EXPECT_GT(summary["depth_registered_frames"], kSimulatedFrames / 2);
  EXPECT_EQ(summary["poorly_constrained_frames"], 0);
  EXPECT_LT(absolute_error(recording, out() / "trajectory.txt"), 0.01);
}

TEST_P(PlainScenes, ASlideDownACorridorIsReported) {
  if (sanitized_build()) GTEST_SKIP() << "takes minutes under a sanitizer";
  const fs::path recording = recording_of("plain_corridor", 150);
  const auto summary = run(recording);
  EXPECT_EQ(summary["tracked_frames"], 150);
  EXPECT_GT(summary["poorly_constrained_frames"], 90);  // 113 to 120 in 30 threaded runs
}

INSTANTIATE_TEST_SUITE_P(Modes, PlainScenes, ::testing::Values("inline", "threaded"),
                         [](const auto& mode) { return std::string(mode.param); });

}  // namespace
}  // namespace stillpoint::testing
