// `stillpoint plugins check`: what is shipped passes, and each careless plugin fails in the case
// made for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
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

INSTANTIATE_TEST_SUITE_P(Libraries, PluginsCheckShipped,
                         ::testing::Values("decision_objects", "map_checks", "map_octomap",
                                           "map_voxel_cloud", "moving_checks", "orb_slam",
                                           "output_files", "output_mcap", "propagator_flow_depth",
                                           "segmenter_opencv_dnn"));

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

/// Of source and output `ros2`, the output; the source waits for images.
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
