// A recording of a real sensor, when it is there.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "support/absolute_error.hpp"
#include "support/pasted_people.hpp"
#include "support/shared_data.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;

TEST(RealRecording, IsTrackedToTheEnd) {
  const fs::path recording = shared_data() / "data/tum_fr1_xyz";
  if (!fs::exists(recording)) GTEST_SKIP() << "no recording in " << recording;
  const int kFrames = sanitized_build() ? 30 : 200;
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

// Two people who cover up to a quarter of the image.
TEST(RealRecording, WithRealPeopleIsTrackedAsWell) {
  if (sanitized_build()) GTEST_SKIP() << "a network takes minutes under a sanitizer";
  const fs::path recording = shared_data() / "data/tum_fr1_xyz", photos = shared_data() / "photos";
  if (!fs::exists(recording) || !fs::exists(photos))
    GTEST_SKIP() << "no " << recording << " or " << photos;
  const TemporaryFolder folder;
  const fs::path with_people = folder.path() / "with_people";
  const people::Coverage coverage = paste_two_people(recording, photos, 250, 150, with_people);
  EXPECT_GT(coverage.max, 0.2);
  std::map<std::string, double> error;
  for (const std::string pipeline : {"orb_baseline", "stillpoint"}) {
    const fs::path out = folder.path() / pipeline;
    const Outcome outcome = call({"run", pipeline, "--dataset", with_people.string(), "--camera",
                                  "tum_fr1", "-o", out.string(), "--set", "runtime.mode=inline"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(json_file(out / "summary.json")["coverage"], 1.0) << pipeline;
    error[pipeline] = absolute_error(with_people, out / "trajectory.txt");
  }
  EXPECT_LT(error["stillpoint"], 0.02);
  EXPECT_GT(error["orb_baseline"], 3 * error["stillpoint"]);
}

}  // namespace
}  // namespace stillpoint::testing
