// `stillpoint plugins check`: each careless plugin fails in the case made for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "support/plugin_libraries.hpp"
#include "support/program.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Careless {
  const char* how;
  const char* failing;  // case
  const char* what;
};

class PluginsCheckCareless : public ::testing::TestWithParam<Careless> {};

TEST_P(PluginsCheckCareless, FailsInTheCaseMadeForIt) {
  const std::string how = std::string("how=") + GetParam().how;
  const Outcome outcome =
      call({"plugins", "check", plugin_library(kBadPlugins, "careless"), "careless", "--set", how,
            "--case", GetParam().failing, "--timeout", "20", "--json"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 of 1 cases failed"));
  const nlohmann::json result = nlohmann::json::parse(outcome.out)["types"][0]["cases"][0];
  EXPECT_EQ(result["outcome"], "failed");
  EXPECT_EQ(result["name"], GetParam().failing);
  const nlohmann::json& finding = result["finding"];
  EXPECT_THAT(finding["what"], HasSubstr(GetParam().what));
  EXPECT_GT(finding["why"].get<std::string>().size(), 20U);
  EXPECT_GT(finding["remedy"].get<std::string>().size(), 20U);
}

constexpr Careless kCareless[] = {
    {"random", "one seed, two runs", "two runs with one seed gave different results"},
    {"shared", "two stages at once", "called in turn, gave other results than one alone"},
    {"reused", "usual recording", "an image that it had given changed during a later call"},
    {"unknown_labels", "no labels, no moving points, no weights", "it crashed: SIGSEGV"},
    {"fixed_size", "images of 161 x 121 pixels",
     "the weights have 320 x 240 pixels, but the frame has 161 x 121"},
    {"unfinished", "destroyed at any time", "its destructor failed: it crashed: SIGSEGV"},
    {"writes", "usual recording", "it wrote to an image of a frame, which all stages share"},
    {"depth", "images without depth", "decide failed on frame 1: no depth"},
    {"index", "large indices and ids", "a negative index"},
    {"background", "everything is a person", "no background"},
    {"black", "black images", "a black image"},
    {"data", "black images", "nothing to see"},
    {"rest", "a camera at rest", "no motion"},
    {"options", "options", "read back as others"},
    {"thread", "usual recording", "a thread of its own was ended by SIGSEGV"},
};
INSTANTIATE_TEST_SUITE_P(Ways, PluginsCheckCareless, ::testing::ValuesIn(kCareless),
                         [](const auto& careless) { return std::string(careless.param.how); });

/// Stages of the other kinds.
struct Forgetful {
  const char* kind;
  const char* how;  // may be empty
  const char* failing;
  const char* what;
};

class PluginsCheckForgetful : public ::testing::TestWithParam<Forgetful> {};

TEST_P(PluginsCheckForgetful, FailsInTheCaseMadeForIt) {
  const Forgetful& wrong = GetParam();
  std::vector<std::string> arguments = {"plugins",
                                        "check",
                                        plugin_library(kBadPlugins, "forgetful"),
                                        std::string(wrong.kind) + "/forgetful",
                                        "--case",
                                        wrong.failing,
                                        "--json"};
  if (wrong.how[0] != 0)
    arguments.insert(arguments.end(), {"--set", std::string("how=") + wrong.how});
  const Outcome outcome = call(arguments);
  ASSERT_EQ(outcome.exit_code, 1) << outcome.err << outcome.out;
  const nlohmann::json result = nlohmann::json::parse(outcome.out)["types"][0]["cases"][0];
  EXPECT_EQ(result["outcome"], "failed");
  EXPECT_THAT(result["finding"]["what"], HasSubstr(wrong.what));
  EXPECT_GT(result["finding"]["remedy"].get<std::string>().size(), 20U);
}

constexpr const char* kUsual = "usual recording";
constexpr const char* kLargeIds = "large indices and ids";
constexpr const char* kNoFrame = "ended before the first frame";
constexpr Forgetful kForgetful[] = {
    {"source", "size", kUsual, "size() said 1 frames, but next() gave 2"},
    {"source", "goes_on", kUsual, "next() gave a frame after the end"},
    {"segmenter", "", kUsual, "classes() gives 1 names"},
    {"propagator", "", kUsual, "propagate() wrote to the labels"},
    {"moving_checker", "", kLargeIds, "no such key frame"},
    {"map_checker", "", kLargeIds, "no such key frame"},
    {"tracker", "", kLargeIds, "no such key frame"},
    {"local_mapper", "", kLargeIds, "no such key frame"},
    {"loop_closer", "ids", kLargeIds, "no such key frame"},
    {"loop_closer", "wrong", "a place seen again", "moved key frame 20 away from where it is"},
    {"map_backend", "ids", kLargeIds, "no such key frame"},
    {"map_backend", "weights", "all weights are 0", "nothing to map"},
    {"map_backend", "empty_file", kUsual, "save() wrote an empty file, map.txt"},
    {"map_backend", "position", kUsual, "a point of occupied() has no finite position"},
    {"map_backend", "occupancy", kUsual, "a point of occupied() has occupancy 100"},
    {"map_backend", "clear", kUsual, "clear() left 1 occupied cells"},
    {"output", "ids", kLargeIds, "no such key frame"},
    {"output", "steers", kUsual, "begin failed: the program has named no file"},
    {"output", "holds", "frames that a program gives", "it cannot be held up"},
    {"output", "one_frame", "a single frame", "no way to speak of"},
    {"output", "no_frame", kNoFrame, "no frame to show"},
    {"output", "replaces", kNoFrame, "a run without a frame replaced frames.txt"},
    {"output", "finishes", kNoFrame, "a run without a frame replaced frames.txt"},
};
INSTANTIATE_TEST_SUITE_P(Kinds, PluginsCheckForgetful, ::testing::ValuesIn(kForgetful),
                         [](const auto& wrong) {
                           return std::string(wrong.param.kind) + "_" +
                                  (wrong.param.how[0] != 0 ? wrong.param.how : "one_way");
                         });

TEST(PluginsCheck, EveryCaseHasAStageThatFailsInIt) {
  std::set<std::string> failed = {"a map that stays as it is"};  // by a tracker, below
  for (const Careless& careless : kCareless) failed.insert(careless.failing);
  for (const Forgetful& wrong : kForgetful) failed.insert(wrong.failing);
  for (const std::string kind : {"map_checker", "tracker", "loop_closer", "output"}) {
    const Outcome outcome = call({"plugins", "check", plugin_library(kBadPlugins, "forgetful"),
                                  kind + "/forgetful", "--json"});
    const nlohmann::json result = nlohmann::json::parse(outcome.out);
    ASSERT_GT(result["types"][0]["cases"].size(), 10U) << kind;
    for (const nlohmann::json& one : result["types"][0]["cases"])
      EXPECT_TRUE(failed.contains(one["name"].get<std::string>()))
          << "no stage is made to fail in " << one["name"];
  }
}

TEST(PluginsCheck, ALoopCloserThatClosesNoneIsToldSo) {
  const std::vector<std::string> arguments = {
      "plugins", "check", plugin_library(kBadPlugins, "forgetful"), "loop_closer/forgetful"};
  const Outcome outcome = call(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("  -     a place seen again"));
  EXPECT_THAT(outcome.out,
              HasSubstr("not checked: it closed no loop, although the camera came back"));
}

TEST(PluginsCheck, ATrackerThatChangesAMapThatStaysAsItIsFails) {
  const Outcome outcome =
      call({"plugins", "check", plugin_library(kBadPlugins, "wrong_results"), "tracker/wrong",
            "--set", "how=right", "--case", "a map that stays as it is"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("it made a key frame, but the map stays as it is"));
  EXPECT_THAT(outcome.err, HasSubstr("1 of 1 cases failed"));
}

TEST(PluginsCheck, AMapThatIsNotSavedFails) {
  const Outcome outcome = call({"plugins", "check", plugin_library(kBadPlugins, "wrong_results"),
                                "map_backend/wrong", "--case", "usual recording"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("save() wrote no file, although key frames were integrated"));
}

TEST(PluginsCheck, AnOutputThatForgetsToCommitItsFileFails) {
  const Outcome outcome = call({"plugins", "check", plugin_library(kBadPlugins, "wrong_results"),
                                "output/wrong", "--case", "usual recording"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out,
              HasSubstr("finish() leaves a file whose name ends in .part, wrong.txt."));
}

TEST(PluginsCheck, TheyPassTheUsualRecording) {
  for (const std::string how : {"shared", "fixed_size", "unfinished"}) {
    const Outcome outcome = call({"plugins", "check", plugin_library(kBadPlugins, "careless"),
                                  "--set", "how=" + how, "--case", "usual recording"});
    EXPECT_EQ(outcome.exit_code, 0) << how << outcome.out << outcome.err;
  }
}

TEST(PluginsCheck, AStageThatHangsCostsItsCaseOnly) {
  const Outcome outcome = call({"plugins", "check", plugin_library(kBadPlugins, "careless"),
                                "--set", "how=hang", "--timeout", "2"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("it did not end within 2 s"));
}

TEST(PluginsCheck, CtrlCEndsItAndLeavesNothing) {
  const TemporaryFolder folder;
  Program program(
      {"plugins", "check", plugin_library(kBadPlugins, "careless"), "--set", "how=hang"},
      {.environment = {{"TMPDIR", folder.path().string()}}});
  const auto case_has_begun = [&] {  // it has made a folder of its own in the check's
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
      if (!fs::is_empty(entry.path())) return true;
    return false;
  };
  while (!case_has_begun()) std::this_thread::yield();
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.signal, SIGINT);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(PluginsCheck, NeedsAFolderForItsFiles) {
  const Outcome outcome = call({"plugins", "check", plugin_library(kShippedPlugins, "map_checks")},
                               {.environment = {{"TMPDIR", "/nowhere"}}});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(
      outcome.err,
      HasSubstr("a temporary folder: cannot be made: No such file or directory; set TMPDIR to"));
}

TEST(PluginsCheck, LibrariesThatCannotBeUsedSayWhy) {
  const auto check = [](const std::string& file) {
    const Outcome outcome = call({"plugins", "check", file, "--timeout", "2"});
    EXPECT_EQ(outcome.exit_code, 1) << file;
    return outcome.out;
  };
  EXPECT_THAT(check(plugin_library(kBadPlugins, "wrong_tag")),
              HasSubstr("cannot be used: built with gcc7"));
  EXPECT_THAT(check(plugin_library(kBadPlugins, "no_stamp")), HasSubstr("cannot be used: "));
  EXPECT_THAT(check(plugin_library(kBadPlugins / "crashes_when_loaded", "crashes_when_loaded")),
              HasSubstr("it crashed: SIGSEGV"));
  EXPECT_THAT(check(plugin_library(kBadPlugins / "hangs_when_loaded", "hangs_when_loaded")),
              HasSubstr("it did not end within 2 s"));
  for (const char* fault :
       {"two options are named 'points'", "must not be named 'type'",
        "must not be named 'when_full'", "the default of 'share', 2, is outside",
        "the default of 'shares' has a number outside its range"})
    EXPECT_THAT(check(plugin_library(kBadPlugins, "bad_options")), HasSubstr(fault));
}

TEST(PluginsCheck, TheFolderMayStandBeforeAndBehindTheCommand) {
  for (const auto& words : {std::vector<std::string>{"plugins", "--path", kBadPlugins, "list"},
                            std::vector<std::string>{"plugins", "list", "--path", kBadPlugins}})
    EXPECT_THAT(call(words).out, HasSubstr("libstillpoint_careless.so"));
}

TEST(PluginsCheck, RefusesWhatIsNotThere) {
  const auto error_of = [](const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {"plugins", "check"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = call(all);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
    return outcome.err;
  };
  const std::string good = plugin_library(kShippedPlugins, "map_checks");
  EXPECT_THAT(error_of({"nowhere.so"}), HasSubstr("nowhere.so: there is no such file"));
  EXPECT_THAT(error_of({kBadPlugins.string()}),
              HasSubstr("plugins: is a folder; give the library"));
  EXPECT_THAT(error_of({good, "depth_consistancy"}),
              HasSubstr("did you mean 'depth_consistency'?"));
  EXPECT_THAT(error_of({good, "--case", "black image"}), HasSubstr("did you mean 'black images'?"));
  const Outcome unknown = call({"plugins", "check", good, "--set", "margn=1"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.out, HasSubstr("unknown key 'margn'; did you mean 'margin'?"));
}

}  // namespace
}  // namespace stillpoint::testing
