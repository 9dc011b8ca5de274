// A recording of a real sensor, when it is there.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/shared_data.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;

TEST(RealRecording, IsTrackedToTheEnd) {
  const fs::path recording = shared_data() / "data/tum_fr1_xyz";
  if (!fs::exists(recording)) GTEST_SKIP() << "no recording in " << recording;
  constexpr int kFrames = kSanitized ? 30 : 200;
  const TemporaryFolder folder;
  const Outcome outcome =
      call({"run", "orb_baseline", "--dataset", recording.string(), "--camera", "tum_fr1", "-o",
            folder.path().string(), "--set", "source.limit=" + std::to_string(kFrames)});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto summary = json_file(folder.path() / "summary.json");
  EXPECT_EQ(summary["frames"], kFrames);
  EXPECT_EQ(summary["coverage"], 1.0);
  EXPECT_EQ(summary["skipped_images"], 0);
  EXPECT_LT(absolute_error(recording, folder.path() / "trajectory.txt"), 0.02);
}

}  // namespace
}  // namespace stillpoint::testing
