// A stage of any kind that never returns, on the thread of its kind, is named and can be given up.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "bad_setup_fixture.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Hanging {
  const char* role;  // what messages call the stage
  const char* setting;
  const char* another = "runtime.seed=1";  ///< setting
};

/// Hangs on the thread of its kind. The moving check has a test of its own.
class StageOfAnyKind : public BadPlugins,
                       public ::testing::WithParamInterface<std::tuple<const char*, Hanging>> {};

INSTANTIATE_TEST_SUITE_P(
    Modes, StageOfAnyKind,
    ::testing::Combine(::testing::Values("inline", "threaded"),
                       ::testing::Values(Hanging{"source", "source={type: hangs}"},
                                         Hanging{"propagation", "propagator={type: hangs}",
                                                 "segmenter={type: labels}"},
                                         Hanging{"map check", "map_checker={type: hangs}"},
                                         Hanging{"decision", "decision={type: hangs}"},
                                         Hanging{"tracking", "tracker={type: hangs}"},
                                         Hanging{"segmentation", "segmenter={type: hangs}"},
                                         Hanging{"local mapping", "local_mapper={type: hangs}"},
                                         Hanging{"loop closing", "loop_closer={type: hangs}"},
                                         Hanging{"dense mapping", "map_backend={type: hangs}"},
                                         Hanging{"output",
                                                 "outputs=[{type: hangs}, {type: summary}]"},
                                         Hanging{"output",
                                                 "outputs=[{type: hangs, when_full: drop}, "
                                                 "{type: summary}]"})),
    [](const auto& test) {
      std::string name = std::to_string(test.index) + "_" + std::get<1>(test.param).role;
      std::ranges::replace(name, ' ', '_');
      return name;
    });

TEST_P(StageOfAnyKind, ThatHangsIsNamedAndGivenUpByTheSecondCtrlC) {
  const auto& [mode, hanging] = GetParam();
  const std::string stage = std::string(hanging.role) + " (hangs)";
  std::vector<std::string> arguments = {"--set", hanging.setting,
                                        "--set", hanging.another,
                                        "--set", std::string("runtime.mode=") + mode,
                                        "--set", "runtime.stage_timeout=0.1"};
  if (hanging.role != std::string("source")) arguments = on_recording(arguments);
  arguments.insert(arguments.begin(), {"run", "orb_baseline", "-o", out().string()});
  Program program(std::move(arguments), with_plugins());
  ASSERT_TRUE(program.wait_for("warning: " + stage + " has not returned for "));
  program.send(SIGINT);
  ASSERT_TRUE(program.wait_for("Ctrl-C again gives it up"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
  EXPECT_THAT(outcome.err, HasSubstr("error: " + stage + " failed on frame "));
  const std::string failure = json_file(out() / "summary.json")["failure"];
  EXPECT_THAT(failure, HasSubstr("it did not return and was given up"));
}

// Nothing of a stage is under way in its process: the stage hangs in that of the run.
class StudyWhoseRunHangs : public BadPlugins {};

TEST_F(StudyWhoseRunHangs, EndsAtTheSecondCtrlC) {
  const fs::path study =
      folder_.write("hangs.yaml",
                    "version: 1\n"
                    "sequences: [{name: s, scene: fr3_walking_xyz_empty, frames: 5}]\n"
                    "variants:\n"
                    "  - name: v\n"
                    "    pipeline: orb_baseline\n"
                    "    set: ['tracker={type: hangs}', runtime.stage_timeout=0.1]\n");
  Program program({"ablate", study.string(), "-o", out().string()}, with_plugins());
  ASSERT_TRUE(program.wait_for_text(out() / "runs/s/v/0/console.txt", "has not returned"));
  program.send(SIGINT);
  ASSERT_TRUE(program.wait_for("Ctrl-C again ends it at once"));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().signal, SIGINT);
}

}  // namespace
}  // namespace stillpoint::testing
