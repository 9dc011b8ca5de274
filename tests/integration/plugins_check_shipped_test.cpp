// `stillpoint plugins check`: what is shipped passes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/dds_loopback.hpp"
#include "support/image_io.hpp"
#include "support/plugin_libraries.hpp"
#include "support/program.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class PluginsCheckShippedPlugins : public ::testing::TestWithParam<const char*> {};

TEST_P(PluginsCheckShippedPlugins, Passes) {
  const Outcome outcome = call({"plugins", "check", plugin_library(kShippedPlugins, GetParam())});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(" cases passed"));
}

constexpr const char* kCheckedAsTheyAre[] = {"decision_objects",      "map_checks",
                                             "map_octomap",           "map_voxel_cloud",
                                             "moving_checks",         "orb_slam",
                                             "output_files",          "output_mcap",
                                             "propagator_flow_depth", "segmenter_opencv_dnn"};
INSTANTIATE_TEST_SUITE_P(Libraries, PluginsCheckShippedPlugins,
                         ::testing::ValuesIn(kCheckedAsTheyAre));

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
  for (const fs::directory_entry& entry : fs::directory_iterator(kShippedPlugins)) {
    if (entry.path().extension() != ".so") continue;
    const std::string name = entry.path().stem().string().substr(std::strlen("libstillpoint_"));
    EXPECT_TRUE(checked.contains(name)) << name << " is checked by no test";
  }
}

TEST(PluginsCheck, TheLoopCloserClosesALoop) {
  const Outcome outcome = call({"plugins", "check", plugin_library(kShippedPlugins, "orb_slam"),
                                "loop_closer/orb", "--case", "a place seen again"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(" closed, "));
}

TEST(PluginsCheck, TheSimulatorPasses) {
  const Outcome outcome =
      call({"plugins", "check", plugin_library(kShippedPlugins, "source_simulation"), "--set",
            "frames=2", "--set", "room.furnished=false", "--timeout", "300"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

// Two of its cases have two stages at once, which cannot have the same port.
TEST(PluginsCheck, TheLiveViewPasses) {
  const Outcome outcome =
      call({"plugins", "check", plugin_library(kShippedPlugins, "output_web"), "--set", "port=0"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

TEST(PluginsCheck, StagesThatReadARecordingAreCheckedWithOne) {
  const std::string path = "path=" + simulated_recording().string();
  const std::string camera = (simulated_recording() / "camera.yaml").string();
  Outcome outcome = call({"plugins", "check", plugin_library(kShippedPlugins, "source_tum"),
                          "--set", path, "--camera", camera});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  outcome = call({"plugins", "check", plugin_library(kShippedPlugins, "source_tum")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.out, HasSubstr("not checked: source (tum_rgbd): no recording is given"));
  EXPECT_THAT(outcome.out, HasSubstr("give what it needs with --set OPTION=VALUE"));
  EXPECT_THAT(outcome.err, HasSubstr("nothing could be checked"));
}

TEST(PluginsCheck, ATypeThatCannotBeMadeIsNotPassedOver) {
  const Outcome outcome = call({"plugins", "check", plugin_library(kBadPlugins, "second_good")});
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("not checked: moving_checker (needs_model): model: no model"));
  EXPECT_THAT(outcome.out, ::testing::Not(HasSubstr("FAIL")));
  EXPECT_THAT(outcome.err, HasSubstr("moving_checker/needs_model: could not be checked"));
}

TEST(PluginsCheck, TheSegNetPasses) {
  const Outcome outcome =
      call({"plugins", "check", plugin_library(kShippedPlugins, "segmenter_segnet"), "--set",
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
      call({"plugins", "check", plugin_library(kShippedPlugins, "segmenter_label_images"), "--set",
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
  const Outcome outcome = call(
      {"plugins", "check", plugin_library(kShippedPlugins, "source_bag"), "--set", "path=" + bag});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

/// With the device that OpenNI 2 makes up for tests. Two runs see different images, as with any
/// camera.
TEST(PluginsCheck, ACameraOfOpenNi2Passes) {
  const TemporaryFolder folder;
  const fs::path camera = folder.write("camera.yaml",
                                       "version: 1\n"
                                       "camera: {width: 320, height: 240, fx: 260, fy: 260, cx: "
                                       "159.5, cy: 119.5, depth_factor: 5000}\n");
  if (!fs::exists(plugin_library(kShippedPlugins, "source_openni2")))
    GTEST_SKIP() << "source_openni2 is not built here";
  const Outcome outcome =
      call({"plugins", "check", plugin_library(kShippedPlugins, "source_openni2"), "--set",
            "device=Dummy", "--set", "width=320", "--set", "height=240", "--set", "limit=5",
            "--camera", camera.string()});
  if (outcome.exit_code == 2) GTEST_SKIP() << "OpenNI 2 has no driver DummyDevice here";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("right for a camera"));
  EXPECT_THAT(outcome.out, HasSubstr("ok    destroyed at any time"));
}

/// The source waits for images, which only the tests of plugins/ros2 can publish.
TEST(PluginsCheck, OfTheSourceForRos2OptionsAndItsMessage) {
  if (!fs::exists(plugin_library(kShippedPlugins, "ros2")))
    GTEST_SKIP() << "ros2 is not built here";
  const std::vector<std::string> arguments = {
      "plugins", "check", plugin_library(kShippedPlugins, "ros2"), "source/ros2"};
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
  const std::string file = plugin_library(kShippedPlugins, "source_video");
  if (!fs::exists(file)) GTEST_SKIP() << "source_video is not built here";
  const Outcome outcome = call({"plugins", "check", file, "--case", "options"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

/// Of source and output `ros2`, the output.
TEST(PluginsCheck, TheOutputForRos2Passes) {
  if (!fs::exists(plugin_library(kShippedPlugins, "ros2")))
    GTEST_SKIP() << "ros2 is not built here";
  const Outcome outcome =
      call({"plugins", "check", plugin_library(kShippedPlugins, "ros2"), "output/ros2", "--set",
            "domain=" + std::to_string(loopback_domain())},
           {.environment = {{"ROS_LOCALHOST_ONLY", "1"}}});
  if (outcome.err.find("DDS is not installed") != std::string::npos)
    GTEST_SKIP() << "DDS is not installed";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace stillpoint::testing
