// `stillpoint plugins check`: what is shipped passes, and each careless plugin fails in the case
// made for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "support/dds_loopback.hpp"
#include "support/image_io.hpp"
#include "support/program.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const fs::path kShipped = build_folder() / "lib/stillpoint/plugins";
const fs::path kBad = fs::path(STILLPOINT_BINARY_DIR) / "tests/plugins_bad/plugins";

std::string library(const fs::path& folder, const std::string& name) {
  return (folder / ("libstillpoint_" + name + ".so")).string();
}

class PluginsCheckShipped : public ::testing::TestWithParam<const char*> {};

TEST_P(PluginsCheckShipped, Passes) {
  const Outcome outcome = call({"plugins", "check", library(kShipped, GetParam())});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(" cases passed"));
}

constexpr const char* kCheckedAsTheyAre[] = {"decision_objects",      "map_checks",
                                             "map_octomap",           "map_voxel_cloud",
                                             "moving_checks",         "orb_slam",
                                             "output_files",          "output_mcap",
                                             "propagator_flow_depth", "segmenter_opencv_dnn"};
INSTANTIATE_TEST_SUITE_P(Libraries, PluginsCheckShipped, ::testing::ValuesIn(kCheckedAsTheyAre));

/// By tests below, which give them what they need; `source_freenect` by tests/cameras.
constexpr const char* kCheckedWithMore[] = {"output_web",
                                            "ros2",
                                            "segmenter_label_images",
                                            "segmenter_segnet",
                                            "source_bag",
                                            "source_freenect",
                                            "source_openni2",
                                            "source_simulation",
                                            "source_tum",
                                            "source_video"};

TEST(PluginsCheck, LeavesOutNoShippedLibrary) {
  std::set<std::string> checked(std::begin(kCheckedAsTheyAre), std::end(kCheckedAsTheyAre));
  checked.insert(std::begin(kCheckedWithMore), std::end(kCheckedWithMore));
  for (const fs::directory_entry& entry : fs::directory_iterator(kShipped)) {
    if (entry.path().extension() != ".so") continue;
    const std::string name = entry.path().stem().string().substr(std::strlen("libstillpoint_"));
    EXPECT_TRUE(checked.contains(name)) << name << " is checked by no test";
  }
}

TEST(PluginsCheck, TheLoopCloserClosesALoop) {
  const Outcome outcome = call({"plugins", "check", library(kShipped, "orb_slam"),
                                "loop_closer/orb", "--case", "a place seen again"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(" closed, "));
}

TEST(PluginsCheck, TheSimulatorPasses) {
  const Outcome outcome = call({"plugins", "check", library(kShipped, "source_simulation"), "--set",
                                "frames=2", "--set", "room.furnished=false", "--timeout", "300"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

// Two of its cases have two stages at once, which cannot have the same port.
TEST(PluginsCheck, TheLiveViewPasses) {
  const Outcome outcome =
      call({"plugins", "check", library(kShipped, "output_web"), "--set", "port=0"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

TEST(PluginsCheck, StagesThatReadARecordingAreCheckedWithOne) {
  const std::string path = "path=" + simulated_recording().string();
  const std::string camera = (simulated_recording() / "camera.yaml").string();
  Outcome outcome = call(
      {"plugins", "check", library(kShipped, "source_tum"), "--set", path, "--camera", camera});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  outcome = call({"plugins", "check", library(kShipped, "source_tum")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.out, HasSubstr("not checked: source (tum_rgbd): no recording is given"));
  EXPECT_THAT(outcome.out, HasSubstr("give what it needs with --set OPTION=VALUE"));
  EXPECT_THAT(outcome.err, HasSubstr("nothing could be checked"));
}

TEST(PluginsCheck, ATypeThatCannotBeMadeIsNotPassedOver) {
  const Outcome outcome = call({"plugins", "check", library(kBad, "second_good")});
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("not checked: moving_checker (needs_model): model: no model"));
  EXPECT_THAT(outcome.out, ::testing::Not(HasSubstr("FAIL")));
  EXPECT_THAT(outcome.err, HasSubstr("moving_checker/needs_model: could not be checked"));
}

TEST(PluginsCheck, TheSegNetPasses) {
  const Outcome outcome =
      call({"plugins", "check", library(kShipped, "segmenter_segnet"), "--set",
            "prototxt=segnet_rooms.prototxt", "--set", "model=segnet_rooms.caffemodel", "--set",
            "classes=[background,bottle,chair,diningtable,person,pottedplant,sofa,tvmonitor]"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

// One image of labels for all frames of the usual recording.
TEST(PluginsCheck, LabelImagesPass) {
  const TemporaryFolder folder;
  cv::Mat labels(240, 320, CV_8UC1, cv::Scalar::all(0));
  labels(cv::Rect(100, 60, 60, 140)) = 15;  // a person
  write_image(folder.path() / "0.000000.png", labels);
  const Outcome outcome =
      call({"plugins", "check", library(kShipped, "segmenter_label_images"), "--set",
            "path=" + folder.path().string(), "--set", "max_difference=10"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("labels in 20 of 20 frames"));
}

TEST(PluginsCheck, BagsPass) {
  const TemporaryFolder folder;
  const std::string bag = (folder.path() / "bag.mcap").string();
  const Outcome recorded =
      call({"record", "orb_baseline", "--dataset", simulated_recording().string(), "--set",
            "source.limit=5", "-o", bag});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const Outcome outcome =
      call({"plugins", "check", library(kShipped, "source_bag"), "--set", "path=" + bag});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

/// With the device that OpenNI 2 makes up for tests. Two runs see different images, as with any
/// camera.
TEST(PluginsCheck, ACameraOfOpenNi2Passes) {
  const TemporaryFolder folder;
  const fs::path camera =
      folder.write("camera.yaml",
                   "version: 1\n"
                   "camera: {width: 320, height: 240, fx: 260, fy: 260, cx: 159.5, cy: 119.5}\n");
  if (!fs::exists(library(kShipped, "source_openni2")))
    GTEST_SKIP() << "source_openni2 is not built here";
  const Outcome outcome = call({"plugins", "check", library(kShipped, "source_openni2"), "--set",
                                "device=Dummy", "--set", "width=320", "--set", "height=240",
                                "--set", "limit=5", "--camera", camera.string()});
  if (outcome.exit_code == 2) GTEST_SKIP() << "OpenNI 2 has no driver DummyDevice here";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("right for a camera"));
  EXPECT_THAT(outcome.out, HasSubstr("ok    destroyed at any time"));
}

/// The source waits for images, which only the tests of plugins/ros2 can publish.
TEST(PluginsCheck, OfTheSourceForRos2OptionsAndItsMessage) {
  if (!fs::exists(library(kShipped, "ros2"))) GTEST_SKIP() << "ros2 is not built here";
  const std::vector<std::string> arguments = {"plugins", "check", library(kShipped, "ros2"),
                                              "source/ros2"};
  auto only_options = arguments;
  only_options.insert(only_options.end(), {"--case", "options"});
  EXPECT_EQ(call(only_options).exit_code, 0);
  auto without_publisher = arguments;
  without_publisher.insert(
      without_publisher.end(),
      {"--set", "timeout=0.2", "--set", "domain=" + std::to_string(loopback_domain())});
  const Outcome outcome = call(without_publisher, {.environment = {{"ROS_LOCALHOST_ONLY", "1"}}});
  if (outcome.out.find("DDS is not installed") != std::string::npos)
    GTEST_SKIP() << "DDS is not installed";
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.out, HasSubstr("no message for 0.2 s; publishers: 0"));
}

/// It needs a video or a device, which the tests of its folder make up.
TEST(PluginsCheck, OfSourcesOfVideosTheOptions) {
  const std::string file = library(kShipped, "source_video");
  if (!fs::exists(file)) GTEST_SKIP() << "source_video is not built here";
  const Outcome outcome = call({"plugins", "check", file, "--case", "options"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

/// Of source and output `ros2`, the output.
TEST(PluginsCheck, TheOutputForRos2Passes) {
  if (!fs::exists(library(kShipped, "ros2"))) GTEST_SKIP() << "ros2 is not built here";
  const Outcome outcome = call({"plugins", "check", library(kShipped, "ros2"), "output/ros2",
                                "--set", "domain=" + std::to_string(loopback_domain())},
                               {.environment = {{"ROS_LOCALHOST_ONLY", "1"}}});
  if (outcome.err.find("DDS is not installed") != std::string::npos)
    GTEST_SKIP() << "DDS is not installed";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

struct Careless {
  const char* how;
  const char* failing;  // case
  const char* what;
};

class PluginsCheckCareless : public ::testing::TestWithParam<Careless> {};

TEST_P(PluginsCheckCareless, FailsInTheCaseMadeForIt) {
  const std::string how = std::string("how=") + GetParam().how;
  const Outcome outcome = call({"plugins", "check", library(kBad, "careless"), "careless", "--set",
                                how, "--case", GetParam().failing, "--timeout", "20", "--json"});
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
                                        library(kBad, "forgetful"),
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
    {"output", "ids", kLargeIds, "no such key frame"},
    {"output", "steers", kUsual, "begin failed: the program has named no file"},
    {"output", "begin", "frames that a program gives", "no run"},
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
    const Outcome outcome =
        call({"plugins", "check", library(kBad, "forgetful"), kind + "/forgetful", "--json"});
    const nlohmann::json result = nlohmann::json::parse(outcome.out);
    ASSERT_GT(result["types"][0]["cases"].size(), 10U) << kind;
    for (const nlohmann::json& one : result["types"][0]["cases"])
      EXPECT_TRUE(failed.contains(one["name"].get<std::string>()))
          << "no stage is made to fail in " << one["name"];
  }
}

TEST(PluginsCheck, ALoopCloserThatClosesNoneIsToldSo) {
  const std::vector<std::string> arguments = {"plugins", "check", library(kBad, "forgetful"),
                                              "loop_closer/forgetful"};
  const Outcome outcome = call(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("  -     a place seen again"));
  EXPECT_THAT(outcome.out,
              HasSubstr("not checked: it closed no loop, although the camera came back"));
}

TEST(PluginsCheck, ATrackerThatChangesAMapThatStaysAsItIsFails) {
  const Outcome outcome = call({"plugins", "check", library(kBad, "wrong_results"), "tracker/wrong",
                                "--set", "how=right", "--case", "a map that stays as it is"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("it made a key frame, but the map stays as it is"));
  EXPECT_THAT(outcome.err, HasSubstr("1 of 1 cases failed"));
}

TEST(PluginsCheck, AMapThatIsNotSavedFails) {
  const Outcome outcome = call({"plugins", "check", library(kBad, "wrong_results"),
                                "map_backend/wrong", "--case", "usual recording"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("save() wrote no file, although key frames were integrated"));
}

TEST(PluginsCheck, AnOutputThatForgetsToCommitItsFileFails) {
  const Outcome outcome = call({"plugins", "check", library(kBad, "wrong_results"), "output/wrong",
                                "--case", "usual recording"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out,
              HasSubstr("finish() leaves a file whose name ends in .part, wrong.txt."));
}

TEST(PluginsCheck, TheyPassTheUsualRecording) {
  for (const std::string how : {"shared", "fixed_size", "unfinished"}) {
    const Outcome outcome = call({"plugins", "check", library(kBad, "careless"), "--set",
                                  "how=" + how, "--case", "usual recording"});
    EXPECT_EQ(outcome.exit_code, 0) << how << outcome.out << outcome.err;
  }
}

TEST(PluginsCheck, AStageThatHangsCostsItsCaseOnly) {
  const Outcome outcome =
      call({"plugins", "check", library(kBad, "careless"), "--set", "how=hang", "--timeout", "2"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("it did not end within 2 s"));
}

TEST(PluginsCheck, CtrlCEndsItAndLeavesNothing) {
  const TemporaryFolder folder;
  Program program({"plugins", "check", library(kBad, "careless"), "--set", "how=hang"},
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
  const Outcome outcome = call({"plugins", "check", library(kShipped, "map_checks")},
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
  EXPECT_THAT(check(library(kBad, "wrong_tag")), HasSubstr("cannot be used: built with gcc7"));
  EXPECT_THAT(check(library(kBad, "no_stamp")), HasSubstr("cannot be used: "));
  EXPECT_THAT(check(library(kBad / "crashes_when_loaded", "crashes_when_loaded")),
              HasSubstr("it crashed: SIGSEGV"));
  EXPECT_THAT(check(library(kBad / "hangs_when_loaded", "hangs_when_loaded")),
              HasSubstr("it did not end within 2 s"));
  for (const char* fault :
       {"two options are named 'points'", "must not be named 'type'",
        "must not be named 'when_full'", "the default of 'share', 2, is outside",
        "the default of 'shares' has a number outside its range"})
    EXPECT_THAT(check(library(kBad, "bad_options")), HasSubstr(fault));
}

TEST(PluginsCheck, TheFolderMayStandBeforeAndBehindTheCommand) {
  for (const auto& words : {std::vector<std::string>{"plugins", "--path", kBad, "list"},
                            std::vector<std::string>{"plugins", "list", "--path", kBad}})
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
  const std::string good = library(kShipped, "map_checks");
  EXPECT_THAT(error_of({"nowhere.so"}), HasSubstr("nowhere.so: there is no such file"));
  EXPECT_THAT(error_of({kBad.string()}), HasSubstr("plugins: is a folder; give the library"));
  EXPECT_THAT(error_of({good, "depth_consistancy"}),
              HasSubstr("did you mean 'depth_consistency'?"));
  EXPECT_THAT(error_of({good, "--case", "black image"}), HasSubstr("did you mean 'black images'?"));
  const Outcome unknown = call({"plugins", "check", good, "--set", "margn=1"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.out, HasSubstr("unknown key 'margn'; did you mean 'margin'?"));
}

}  // namespace
}  // namespace stillpoint::testing
