// Wrong usage, configuration and plugins, through the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kStageFailed = 1;
constexpr int kWrongUsage = 2;
const fs::path kBuilt = fs::path(STILLPOINT_BINARY_DIR) / "tests/plugins_bad/plugins";

class BadSetup : public ::testing::Test {
 protected:
  std::vector<std::string> command(const std::string& pipeline,
                                   std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(),
                     {"run", pipeline, "-o", out().string(), "--set", "source.limit=6"});
    return arguments;
  }
  Outcome run(const std::string& pipeline, std::vector<std::string> arguments,
              const Surroundings& surroundings = {}) const {
    return call(command(pipeline, std::move(arguments)), surroundings);
  }
  static std::vector<std::string> on_recording(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--dataset", simulated_recording().string()});
    return more;
  }
  static void expect_refused(const Outcome& outcome, const std::string& message) {
    EXPECT_EQ(outcome.exit_code, kWrongUsage) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("error: "));
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_EQ(outcome.out, "");
  }
  fs::path out() const { return folder_.path() / "out"; }

  const TemporaryFolder folder_;
};

TEST_F(BadSetup, CommandLine) {
  expect_refused(call({}), "Run 'stillpoint --help' for help.");
  expect_refused(call({"simulat", "office"}), "no command 'simulat'; did you mean 'simulate'?");
  expect_refused(call({"run"}), "pipeline is required");
  expect_refused(call({"run", "orb_baseline", "--fast"}), "--fast");
  expect_refused(call({"evaluate", "--json"}), "--reference");
  expect_refused(run("orb_baseline", {}), "no recording is given; name its folder with --dataset");
}

TEST_F(BadSetup, NamesThatDoNotExist) {
  expect_refused(run("orb_baselin", on_recording()), "did you mean 'orb_baseline'?");
  expect_refused(run((folder_.path() / "mine.yaml").string(), on_recording()),
                 "mine.yaml: no such pipeline file");
  expect_refused(run("orb_baseline", on_recording({"--camera", "tum_fr11"})),
                 "no camera named 'tum_fr11'; did you mean 'tum_fr1'?");
  expect_refused(run("orb_baseline", on_recording({"--set", "tracker.type=orbs"})),
                 "no tracker named 'orbs'; did you mean 'orb'?");
}

TEST_F(BadSetup, FaultsOfThePipelineFileAreReportedTogether) {
  const fs::path file = folder_.write("mine.yaml",
                                      "version: 1\n"
                                      "source: {type: tum_rgbd, strid: 2}\n"
                                      "tracker: {type: orb, levels: 99}\n"
                                      "local_mapper: {type: orb}\n"
                                      "local_mapper: {type: orb}\n");
  const Outcome outcome = run(file.string(), on_recording());
  expect_refused(outcome, file.string() + ":2:26: error: source: unknown key 'strid'; did you");
  EXPECT_THAT(outcome.err,
              HasSubstr(file.string() + ":3:30: error: tracker.levels = 99 is outside"));
  EXPECT_THAT(outcome.err,
              HasSubstr(file.string() + ":5:1: error: key 'local_mapper' is given twice"));
  EXPECT_FALSE(fs::exists(out())) << "a run folder, though nothing has run";
}

TEST_F(BadSetup, UnreadableYaml) {
  const fs::path file = folder_.write("broken.yaml", "version: 1\nsource: {type: tum_rgbd\n");
  expect_refused(run(file.string(), on_recording()), file.string() + ":3:1: error: not valid YAML");
}

// yaml-cpp takes them for one empty document after the other, without end.
TEST_F(BadSetup, TextsThatBeginWithAComma) {
  const fs::path file = folder_.write("comma.yaml", ", a\n");
  expect_refused(run(file.string(), on_recording()), file.string() + ":1:1: error: not valid YAML");
  expect_refused(run("orb_baseline", on_recording({"--set", "tracker.features=, a"})),
                 "not valid YAML: a value is missing");
  expect_refused(run("orb_baseline", on_recording({"--camera", file.string()})),
                 file.string() + ":1:1: error: not valid YAML: a value is missing");
}

TEST_F(BadSetup, KeysThatAreNestedTooDeeply) {
  std::string key = "a";
  for (int i = 0; i < 60'000; ++i) key += ".a";
  expect_refused(run("orb_baseline", on_recording({"--set", key + "=1"})), "nested too deeply");
}

TEST_F(BadSetup, RunFolderThatCannotBeWritten) {
  const fs::path file = folder_.write("file", "");
  const Outcome outcome = call({"run", "orb_baseline", "--dataset", simulated_recording().string(),
                                "-o", (file / "out").string()});
  expect_refused(outcome, (file / "out").string() + ": cannot write the run folder: ");
  EXPECT_THAT(outcome.err, HasSubstr("choose another one with -o"));
}

TEST_F(BadSetup, SimulateDoesNotTouchARecording) {
  const RecordingCopy recording(1);
  expect_refused(call({"simulate", kScene, "--frames", "1", "-o", recording.path().string()}),
                 recording.path().string());
  expect_refused(call({"simulate", "fr3_wlking_xyz", "-o", out().string()}),
                 "did you mean 'fr3_walking_xyz'?");
}

// Every bad plugin in one folder: each gives its own message and the good ones are still there.
class BadPlugins : public BadSetup {
 protected:
  BadPlugins() {
    for (const auto& file : fs::directory_iterator(kBuilt))
      if (file.is_regular_file())
        fs::copy_file(file.path(), folder_.path() / file.path().filename());
    folder_.write("libstillpoint_text.so", "this is a letter, not a library\n");
    fs::copy_file(kBuilt / "libstillpoint_good.so", truncated());
    truncate_file(truncated(), 0.5);
  }
  fs::path truncated() const { return folder_.path() / "libstillpoint_truncated.so"; }
  Surroundings with_plugins() const {
    return {.environment = {{"STILLPOINT_PLUGIN_PATH", folder_.path().string()}}};
  }
};

TEST_F(BadPlugins, AreListedWithTheirReasonsBesideTheGoodOnes) {
  const Outcome outcome = call({"plugins", "list"}, with_plugins());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* reason :
       {"libstillpoint_text.so: not a shared library", "libstillpoint_truncated.so: truncated",
        "libstillpoint_no_symbol.so: does not export", "libstillpoint_older_api.so: built for",
        "libstillpoint_newer_api.so: built for", "libstillpoint_wrong_tag.so: built with",
        "libstillpoint_undefined_symbol.so: cannot be loaded: undefined symbol"})
    EXPECT_THAT(outcome.out, HasSubstr(reason));
  for (const char* type : {"tum_rgbd", "simulation", "orb", "trajectory", "good"})
    EXPECT_THAT(outcome.out, ::testing::ContainsRegex(std::string(type) + " +[0-9.]+ +/"));
  const Outcome run_among_them = run("orb_baseline", on_recording(), with_plugins());
  EXPECT_EQ(run_among_them.exit_code, 0) << run_among_them.err;
  EXPECT_EQ(count_poses(out() / "trajectory.txt"), 6u);
}

TEST_F(BadPlugins, AListForProgramsAndForScripts) {
  const Outcome good = call({"plugins", "list", "--strict"});
  EXPECT_EQ(good.exit_code, 0) << good.err;
  Surroundings surroundings = with_plugins();
  surroundings.environment["STILLPOINT_PLUGIN_PATH"] += ":/nowhere";
  const Outcome bad = call({"plugins", "list", "--strict", "--json"}, surroundings);
  EXPECT_EQ(bad.exit_code, 2);
  const auto list = nlohmann::json::parse(bad.out);
  EXPECT_GT(list["types"].size(), 20u);
  EXPECT_TRUE(list["types"][0].contains("library"));
  EXPECT_GT(list["unusable"].size(), 5u);
  EXPECT_EQ(list["missing_folders"], nlohmann::json({"/nowhere"}));
  EXPECT_THAT(call({"plugins", "list"}, surroundings).out,
              HasSubstr("folders that are not there:\n  /nowhere\n"));
}

TEST_F(BadPlugins, ReasonsExplainWhyATypeIsMissing) {
  const Outcome outcome =
      run("orb_baseline", on_recording({"--set", "moving_checker.type=older_api"}), with_plugins());
  expect_refused(outcome, "no moving_checker named 'older_api'");
  EXPECT_THAT(outcome.err, HasSubstr("not usable: libstillpoint_"));
  EXPECT_THAT(outcome.err, HasSubstr("rebuild it against Stillpoint"));
  EXPECT_THAT(outcome.err, HasSubstr("searched:   " + folder_.path().string()));
}

TEST_F(BadPlugins, ThrowingConstructorIsNamed) {
  const Outcome outcome =
      run("orb_baseline", on_recording({"--set", "moving_checker.type=throws_in_constructor"}),
          with_plugins());
  EXPECT_EQ(outcome.exit_code, kStageFailed);
  EXPECT_THAT(outcome.err,
              HasSubstr("error: moving_checker (throws_in_constructor): no such model file"));
}

struct MisdeedWhenLoaded {
  const char* plugin;
  const char* reason;  // empty: an exception leaves dlopen() or ends in std::terminate()
};

/// Static constructors that do what no exception tells of.
class LibraryThatMisbehaves : public BadSetup {
 protected:
  static fs::path folder_of(const std::string& plugin) { return kBuilt / plugin; }
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
  std::vector<std::string> in_the_constructor() const {
    std::vector<std::string> all = arguments();
    all.insert(all.end(), {"--set", "moving_checker.at_once=true"});
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

TEST_P(StageThatHangs, IsNamedInItsConstructor) {
  Program program(command("orb_baseline", in_the_constructor()), with_plugins());
  EXPECT_TRUE(program.wait_for("the constructor of moving_checker (misbehaves) has not returned"));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().signal, SIGINT);
}

}  // namespace
}  // namespace stillpoint::testing
