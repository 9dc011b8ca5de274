// Cameras of other rates and sizes, with default options.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/absolute_error.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

struct Images {
  std::string name;
  int frames;
  std::vector<std::string> settings;  // of the scene
};

std::vector<std::string> size(int width, int height, double focal_length_px) {
  const std::string focal_length = std::to_string(focal_length_px);
  return {"camera.width=" + std::to_string(width),
          "camera.height=" + std::to_string(height),
          "camera.fx=" + focal_length,
          "camera.fy=" + focal_length,
          "camera.cx=" + std::to_string((width - 1) / 2.0),
          "camera.cy=" + std::to_string((height - 1) / 2.0)};
}

class RatesAndSizes : public ::testing::TestWithParam<Images> {};

TEST_P(RatesAndSizes, AreTrackedToTheEnd) {
  const auto& [name, frames, settings] = GetParam();
  const std::filesystem::path recording = recording_of(kScene, frames, settings);
  const TemporaryFolder folder;
  const std::filesystem::path out = folder.path() / "run";
  const Outcome outcome = call({"run", "orb_baseline", "--dataset", recording.string(), "-o",
                                out.string(), "--set", "runtime.mode=inline"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto summary = json_file(out / "summary.json");
  EXPECT_EQ(summary["tracked_frames"], frames);
  EXPECT_EQ(summary["times_lost"], 0);
  EXPECT_LT(absolute_error(recording, out / "trajectory.txt"), 0.006);
}

INSTANTIATE_TEST_SUITE_P(Cameras, RatesAndSizes,
                         ::testing::Values(Images{"Hz5", 20, {"source.rate=5"}},
                                           Images{"Hz60", 60, {"source.rate=60"}},
                                           Images{"Px320x240", 60, size(320, 240, 267.5)},
                                           Images{"Px848x480", 30, size(848, 480, 617)},
                                           Images{"Px1280x720", 30, size(1280, 720, 926)}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace stillpoint::testing
