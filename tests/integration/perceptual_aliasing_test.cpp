// Rooms with the same furniture and the same pictures in the same places: none is another one.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/absolute_error.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;

// From the first room through four others.
fs::path walk() {
  return recording_of("suite_alike", 600, with_small_images({"source.motion.speed=1.6"}));
}

class PerceptualAliasing : public ::testing::TestWithParam<const char*> {};

TEST_P(PerceptualAliasing, ClosesNoLoop) {
  if (sanitized_build()) GTEST_SKIP() << "takes minutes under a sanitizer";
  const TemporaryFolder folder;
  const fs::path recording = walk();
  const std::string out = (folder.path() / "run").string();
  const Outcome outcome = call({"run", "orb_baseline", "--dataset", recording.string(), "-o", out,
                                "--set", "runtime.mode=inline", "--set", "loop_closer.type=orb",
                                "--set", std::string("loop_closer.max_drift=") + GetParam()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file(folder.path() / "run/summary.json")["loops_closed"], 0);
  EXPECT_LT(absolute_error(recording, folder.path() / "run/trajectory.txt"), 0.05);
}

// The second one lets a loop be as far off as the way since then: only the images tell.
INSTANTIATE_TEST_SUITE_P(Reach, PerceptualAliasing, ::testing::Values("0.05", "1"),
                         [](const auto& test) {
                           return std::string(test.param) == "1" ? "Anywhere" : "Shipped";
                         });

}  // namespace
}  // namespace stillpoint::testing
