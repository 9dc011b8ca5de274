// Plugins that fail, crash, end the process or never return are named, and what was computed is
// saved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/core/utility.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "bad_setup_fixture.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct MisdeedWhenLoaded {
  const char* plugin;
  const char* reason;  // empty: an exception leaves dlopen() or ends in std::terminate()
};

/// Static constructors that do what no exception tells of.
class LibraryThatMisbehaves : public BadSetup {
 protected:
  static fs::path folder_of(const std::string& plugin) { return kBadPlugins / plugin; }
  static Surroundings with_it(const std::string& plugin) {
    return {.environment = {{"STILLPOINT_PLUGIN_PATH", folder_of(plugin).string()}}};
  }
};

class LibraryThatEndsTheProcess : public LibraryThatMisbehaves,
                                  public ::testing::WithParamInterface<MisdeedWhenLoaded> {};

INSTANTIATE_TEST_SUITE_P(
    Ways, LibraryThatEndsTheProcess,
    ::testing::Values(MisdeedWhenLoaded{"crashes_when_loaded",
                                        "it crashed: SIGSEGV, Segmentation fault"},
                      MisdeedWhenLoaded{"throws_when_loaded", ""},
                      MisdeedWhenLoaded{"exits_when_loaded", "it called std::exit()"}),
    [](const auto& test) { return std::string(test.param.plugin); });

TEST_P(LibraryThatEndsTheProcess, IsNamed) {
  const std::string plugin = GetParam().plugin;
  for (const auto& arguments :
       {std::vector<std::string>{"plugins", "list"}, {"check", "orb_baseline"}}) {
    const Outcome outcome = call(arguments, with_it(plugin));
    EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
    EXPECT_THAT(outcome.err, HasSubstr("error: loading " + folder_of(plugin).string() +
                                       "/libstillpoint_" + plugin + ".so: " + GetParam().reason));
    EXPECT_THAT(outcome.err, HasSubstr("; its static constructors did that"));
  }
}

TEST_F(LibraryThatMisbehaves, IsNamedWhenItsOptionsAreAskedFor) {
  const std::string plugin = "crashes_when_described";
  const Outcome outcome = run("orb_baseline", on_recording(), with_it(plugin));
  EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
  EXPECT_THAT(outcome.err,
              HasSubstr("error: " + folder_of(plugin).string() + "/libstillpoint_" + plugin +
                        ".so: the options of moving_checker 'crashes_when_described': it crashed"));
}

TEST_F(LibraryThatMisbehaves, IsNamedWhileItHangs) {
  Program program({"plugins", "list"}, with_it("hangs_when_loaded"));
  EXPECT_TRUE(program.wait_for("libstillpoint_hangs_when_loaded.so has not returned for "));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().signal, SIGINT);
}

TEST_F(BadPlugins, FailingStageIsNamedAndResultsAreSaved) {
  for (const char* mode : {"inline", "threaded"}) {
    const Outcome outcome = run("orb_baseline",
                                on_recording({"--set", "moving_checker.type=throws_later", "--set",
                                              std::string("runtime.mode=") + mode}),
                                with_plugins());
    EXPECT_EQ(outcome.exit_code, kStageFailed);
    const std::string message =
        "moving check (throws_later) failed on frame 1: text inside the plugin";
    EXPECT_THAT(outcome.err, HasSubstr("error: " + message));
    const auto summary = json_file(out() / "summary.json");
    EXPECT_FALSE(summary["complete"]);
    EXPECT_EQ(summary["failure"], message);
    EXPECT_EQ(count_poses(out() / "trajectory.txt"), 1u);
  }
}

TEST_F(BadPlugins, FailedRunsDoNotKeepPicturesOfEarlierOnes) {
  ASSERT_EQ(
      run("orb_baseline", on_recording({"--set", "outputs=[{type: images, every: 1}]"})).exit_code,
      0);
  ASSERT_TRUE(fs::exists(out() / "images/000000.jpg"));
  const Outcome outcome = run(
      "orb_baseline", on_recording({"--set", "moving_checker.type=throws_later"}), with_plugins());
  EXPECT_EQ(outcome.exit_code, kStageFailed);
  EXPECT_FALSE(fs::exists(out() / "images"));
}

struct Misdeed {
  const char* how;
  const char* reason;
};

/// A moving checker that does at the fourth frame what no exception tells of.
class StageThatMisbehaves : public BadPlugins,
                            public ::testing::WithParamInterface<std::tuple<const char*, Misdeed>> {
 protected:
  std::string mode() const { return std::get<0>(GetParam()); }
  Misdeed misdeed() const { return std::get<1>(GetParam()); }
  std::vector<std::string> arguments() const {
    return on_recording({"--set", "moving_checker.type=misbehaves", "--set",
                         std::string("moving_checker.how=") + misdeed().how, "--set",
                         "runtime.mode=" + mode(), "--set", "runtime.stage_timeout=0.1"});
  }
  std::vector<std::string> in_the_constructor() const { return and_set("at_once"); }
  std::vector<std::string> in_the_destructor() const { return and_set("at_the_end"); }
  std::vector<std::string> and_set(const std::string& option) const {
    std::vector<std::string> all = arguments();
    all.insert(all.end(), {"--set", "moving_checker." + option + "=true"});
    return all;
  }
  void expect_saved(const Outcome& outcome) const {
    const std::string message =
        std::string("moving check (misbehaves) failed on frame 3: ") + misdeed().reason;
    EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
    EXPECT_THAT(outcome.err, HasSubstr("error: " + message));
    EXPECT_THAT(outcome.out, HasSubstr("trajectory.txt"));
    EXPECT_EQ(count_poses(out() / "trajectory.txt"), 3u);
    const auto summary = json_file(out() / "summary.json");
    EXPECT_FALSE(summary["complete"]);
    EXPECT_THAT(summary["failure"].get<std::string>(), ::testing::StartsWith(message));
  }
};

using StageThatEndsTheProcess = StageThatMisbehaves;
INSTANTIATE_TEST_SUITE_P(
    Ways, StageThatEndsTheProcess,
    ::testing::Combine(
        ::testing::Values("inline", "threaded"),
        ::testing::Values(Misdeed{"crash", "it crashed: SIGSEGV, Segmentation fault"},
                          Misdeed{"abort", "it crashed: SIGABRT, Aborted"},
                          Misdeed{"overflow", "it crashed: SIGSEGV, Segmentation fault"},
                          Misdeed{"exit", "it called std::exit()"})),
    [](const auto& test) {
      return std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param).how;
    });

TEST_P(StageThatEndsTheProcess, IsNamedAndResultsAreSaved) {
  expect_saved(run("orb_baseline", arguments(), with_plugins()));
}

TEST_P(StageThatEndsTheProcess, IsNamedInItsConstructor) {
  const Outcome outcome = run("orb_baseline", in_the_constructor(), with_plugins());
  EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
  EXPECT_THAT(outcome.err,
              HasSubstr(std::string("error: moving_checker (misbehaves): ") + misdeed().reason));
}

TEST_P(StageThatEndsTheProcess, IsNamedInItsDestructor) {
  const Outcome outcome = run("orb_baseline", in_the_destructor(), with_plugins());
  EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
  EXPECT_THAT(
      outcome.err,
      HasSubstr(std::string("the destructor of moving_checker (misbehaves): ") + misdeed().reason));
  EXPECT_TRUE(json_file(out() / "summary.json")["complete"]);
  EXPECT_GT(count_poses(out() / "trajectory.txt"), 3u);
}

struct MisdeedOfThread {
  const char* mode;
  const char* how;
  const char* where;
  const char* reason;
};

/// A moving checker that does it at the fourth frame, on a thread that is not the engine's.
class ThreadOfPlugin : public BadPlugins, public ::testing::WithParamInterface<MisdeedOfThread> {};

// OpenCV's pool is seldom used beside the main thread.
INSTANTIATE_TEST_SUITE_P(
    Ways, ThreadOfPlugin,
    ::testing::Values(
        MisdeedOfThread{"inline", "crash", "thread", "it crashed: SIGSEGV, Segmentation fault"},
        MisdeedOfThread{"threaded", "crash", "thread", "it crashed: SIGSEGV, Segmentation fault"},
        MisdeedOfThread{"inline", "throw", "thread", "it crashed: SIGABRT, Aborted"},
        MisdeedOfThread{"threaded", "throw", "thread", "it crashed: SIGABRT, Aborted"},
        MisdeedOfThread{"threaded", "exit", "thread", "it called std::exit()"},
        MisdeedOfThread{"inline", "abort", "awaited_thread", "it crashed: SIGABRT, Aborted"},
        MisdeedOfThread{"threaded", "abort", "awaited_thread", "it crashed: SIGABRT, Aborted"},
        MisdeedOfThread{"inline", "crash", "thread_pool",
                        "it crashed: SIGSEGV, Segmentation fault"}),
    [](const auto& test) {
      const MisdeedOfThread& misdeed = test.param;
      return std::string(misdeed.mode) + "_" + misdeed.how + "_" + misdeed.where;
    });

TEST_P(ThreadOfPlugin, IsNamedAndResultsAreSaved) {
  const MisdeedOfThread& misdeed = GetParam();
  if (std::string(misdeed.where) == "thread_pool" && cv::getNumThreads() < 2)
    GTEST_SKIP() << "OpenCV has no thread beside the caller's";
  const Outcome outcome = run("orb_baseline",
                              on_recording({"--set",
                                            std::string("moving_checker={type: misbehaves, how: ") +
                                                misdeed.how + ", where: " + misdeed.where + "}",
                                            "--set", std::string("runtime.mode=") + misdeed.mode,
                                            "--set", "source.limit=30"}),
                              with_plugins());
  const std::string message = "a thread of " +
                              (folder_.path() / "libstillpoint_misbehaves.so").string() +
                              " failed: " + misdeed.reason;
  EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
  EXPECT_THAT(outcome.err, HasSubstr("error: " + message));
  EXPECT_GE(count_poses(out() / "trajectory.txt"), 3u);
  const auto summary = json_file(out() / "summary.json");
  EXPECT_FALSE(summary["complete"]);
  EXPECT_EQ(summary["failure"], message);
}

struct Crashing {
  const char* kind;
  const char* setting;
  const char* message;
};

/// A stage that would hang in the call that saves, after it has crashed.
class StageThatCrashes : public BadPlugins,
                         public ::testing::WithParamInterface<std::tuple<const char*, Crashing>> {};

INSTANTIATE_TEST_SUITE_P(
    Modes, StageThatCrashes,
    ::testing::Combine(
        ::testing::Values("inline", "threaded"),
        ::testing::Values(Crashing{"output",
                                   "outputs=[{type: crashes_then_hangs}, {type: trajectory}, "
                                   "{type: summary}]",
                                   "output (crashes_then_hangs) failed on frame 3: it crashed"},
                          Crashing{"map_backend", "map_backend.type=crashes_then_hangs",
                                   "dense mapping (crashes_then_hangs) failed on frame "})),
    [](const auto& test) {
      return std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param).kind;
    });

TEST_P(StageThatCrashes, IsNotCalledAgain) {
  const auto& [mode, crashing] = GetParam();
  const Outcome outcome =
      run("orb_baseline",
          on_recording({"--set", crashing.setting, "--set", std::string("runtime.mode=") + mode,
                        "--set", "source.limit=30"}),
          with_plugins());
  EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
  EXPECT_THAT(outcome.err, HasSubstr(std::string("error: ") + crashing.message));
  EXPECT_GE(count_poses(out() / "trajectory.txt"), 1u);
  EXPECT_THAT(json_file(out() / "summary.json")["failure"].get<std::string>(),
              ::testing::StartsWith(crashing.message));
}

TEST_F(BadPlugins, AnOutputInWhoseCallAnotherStageCrashesIsFinished) {
  const Outcome outcome = run("orb_baseline",
                              on_recording({"--set", "map_backend.type=crashes_then_hangs", "--set",
                                            "outputs=[{type: dense_map_reader}, {type: summary}]",
                                            "--set", "runtime.mode=inline"}),
                              with_plugins());
  EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
  EXPECT_THAT(outcome.err, HasSubstr("dense mapping (crashes_then_hangs) failed: it crashed"));
  EXPECT_TRUE(fs::exists(out() / "finished.txt"));
  EXPECT_FALSE(json_file(out() / "summary.json")["complete"]);
}

TEST_F(BadPlugins, CtrlCBeforeTheFirstFrameLeavesEarlierResults) {
  for (const char* mode : {"inline", "threaded"}) {
    ASSERT_EQ(run("orb_baseline", on_recording()).exit_code, 0);
    const std::string summary = text_of(out() / "summary.json");
    Program program({"run", "orb_baseline", "-o", out().string(), "--set",
                     "source={type: slow_camera}", "--set", std::string("runtime.mode=") + mode},
                    with_plugins());
    ASSERT_TRUE(program.wait_for("the camera begins"));
    program.send(SIGINT);
    ASSERT_TRUE(program.wait_for("frame 0; Ctrl-C again gives it up"));
    std::ofstream(out() / "go") << "go";
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.signal, SIGINT);
    EXPECT_THAT(outcome.err, HasSubstr("stopped before the first frame; nothing was written"));
    EXPECT_EQ(text_of(out() / "summary.json"), summary);
    fs::remove(out() / "go");
  }
}

using StageThatWritesToImages = StageThatMisbehaves;
INSTANTIATE_TEST_SUITE_P(
    Modes, StageThatWritesToImages,
    ::testing::Combine(::testing::Values("inline", "threaded"),
                       ::testing::Values(Misdeed{
                           "write", "it wrote to an image of a frame, which all stages share"})),
    [](const auto& test) { return std::string(std::get<0>(test.param)); });

TEST_P(StageThatWritesToImages, IsNamedWhenValidationIsFull) {
  std::vector<std::string> thorough = arguments();
  thorough.insert(thorough.end(), {"--set", "runtime.validate=full"});
  expect_saved(run("orb_baseline", thorough, with_plugins()));
}

using StageThatHangs = StageThatMisbehaves;
INSTANTIATE_TEST_SUITE_P(Modes, StageThatHangs,
                         ::testing::Combine(::testing::Values("inline", "threaded"),
                                            ::testing::Values(Misdeed{
                                                "hang", "it did not return and was given up"})),
                         [](const auto& test) { return std::string(std::get<0>(test.param)); });

TEST_P(StageThatHangs, IsNamedAndGivenUpByTheSecondCtrlC) {
  Program program(command("orb_baseline", arguments()), with_plugins());
  ASSERT_TRUE(program.wait_for("warning: moving check (misbehaves) has not returned for "));
  program.send(SIGINT);
  ASSERT_TRUE(program.wait_for("frame 3; Ctrl-C again gives it up"));
  program.send(SIGINT);
  expect_saved(program.finish());
}

TEST_P(StageThatHangs, IsNamedInItsDestructor) {
  Program program(command("orb_baseline", in_the_destructor()), with_plugins());
  EXPECT_TRUE(program.wait_for("the destructor of moving_checker (misbehaves) has not returned"));
  program.send(SIGINT);
  EXPECT_TRUE(program.wait_for("Ctrl-C again gives it up"));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().signal, SIGINT);
  EXPECT_TRUE(json_file(out() / "summary.json")["complete"]);
}

TEST_P(StageThatHangs, IsNamedInItsConstructor) {
  Program program(command("orb_baseline", in_the_constructor()), with_plugins());
  EXPECT_TRUE(program.wait_for("the constructor of moving_checker (misbehaves) has not returned"));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().signal, SIGINT);
}

}  // namespace
}  // namespace stillpoint::testing
