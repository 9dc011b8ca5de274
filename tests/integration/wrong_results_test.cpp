// Plugins that give what their contract forbids, through the program: the run ends with the stage,
// the frame and what to do, and what was computed is saved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "support/plugin_libraries.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kStageFailed = 1;

struct Wrong {
  const char* kind;  // section of the pipeline file
  const char* role;  // what messages call the stage
  const char* how;
  const char* problem;
  const char* validate = "cheap";
};

constexpr Wrong kWrongs[] = {
    {"source", "source", "index", "the frame has index 7; indices count from 0 without gaps"},
    {"source", "source", "backwards", "s older than the one before; give frames in order of time"},
    {"source", "source", "nan_time", "the time of the frame is not finite"},
    {"source", "source", "depth_type", "the depth image is of CV_16UC1; it must be of CV_32FC1"},
    {"source", "source", "empty", "the frame has no image"},
    {"source", "source", "no_camera", "the frame has no camera; set Frame::camera"},
    {"source", "source", "other_size", "the images have another size than those before"},
    {"segmenter", "segmentation", "size",
     "the labels have 2 x 2 pixels, but the frame has 64 x 48"},
    {"segmenter", "segmentation", "label", "a pixel has label 2, but there are 2 classes"},
    {"segmenter", "segmentation", "frame", "Segmentation::frame is 0 for frame 3"},
    {"segmenter", "segmentation", "pixels", "all objects have 0 pixels, but there are instances"},
    {"propagator", "propagation", "", "Segmentation::frame is 2 for frame 3"},
    {"moving_checker", "moving check", "outside", "a point at 64, 0 is not in the image"},
    {"map_checker", "map check", "size", "the evidence has 1 x 30 cells"},
    {"decision", "decision", "size", "the weights have 2 x 2 pixels, but the frame has 64 x 48"},
    {"decision", "decision", "type", "the weights are of CV_32FC1"},
    {"tracker", "tracking", "nan_pose", "the pose is no rigid motion"},
    {"tracker", "tracking", "reference", "the reference is key frame kNoId of 4"},
    {"tracker", "tracking", "keyframe_id", "the key frame has id 4, but the next one is 3"},
    {"tracker", "tracking", "features", "the key frame has no features"},
    {"tracker", "tracking", "evidence", "evidence of a landmark that is not in the map"},
    {"tracker", "tracking", "two_poses", "are two different poses"},
    {"tracker", "tracking", "octave", "wrong features: a keypoint has octave 1000 of 8"},
    {"tracker", "tracking", "nothing_prepared", "prepare() gave nothing"},
    {"local_mapper", "local mapping", "forgotten", "key frame 3 was not added to the map"},
    {"local_mapper", "local mapping", "nan_pose", "the pose of key frame 3 is no rigid motion"},
    {"local_mapper", "local mapping", "refined_to_nothing", "ids of the map are gone"},
    {"local_mapper", "local mapping", "taken_apart", "key frame 3 has no features"},
    {"loop_closer", "loop closing", "close", "the correction names key frame 4 of 4"},
    {"loop_closer", "loop closing", "adjust", "the correction names key frame "},
    // What is looked at value by value.
    {"source", "source", "nan_depth", "the depth at 2, 1 is nan", "full"},
    {"moving_checker", "moving check", "nan_residual", "the residual of a point is no number",
     "full"},
    {"map_checker", "map check", "nan", "the evidence at 2, 1 is nan", "full"},
    {"tracker", "tracking", "nan_uncertainty", "the uncertainty of the pose is no covariance",
     "full"},
    {"local_mapper", "local mapping", "unseen_landmark", "landmark 0 has no observation", "full"},
    {"local_mapper", "local mapping", "unseen_refined", "landmark 0 has no observation", "full"},
};

class WrongResults : public ::testing::TestWithParam<std::tuple<const char*, Wrong>> {
 protected:
  static Wrong wrong() { return std::get<1>(GetParam()); }

  // Source and tracker of the fixture, so that only it is asked; the rest as the case says.
  fs::path pipeline() const {
    const auto section = [&](const std::string& kind, const std::string& otherwise) {
      if (kind != wrong().kind) return otherwise.empty() ? "" : kind + ": " + otherwise + "\n";
      const std::string how = wrong().how;
      return kind + ": {type: wrong" + (how.empty() ? "" : ", how: " + how) + "}\n";
    };
    return folder_.write("wrong.yaml",
                         "version: 1\n" + section("source", "{type: wrong, how: right}") +
                             section("segmenter", segmenter_for_propagator()) +
                             section("propagator", "") + section("moving_checker", "") +
                             section("map_checker", "") + section("decision", "") +
                             section("tracker", "{type: wrong, how: right}") +
                             section("local_mapper", "") + section("loop_closer", "") +
                             "outputs: [{type: trajectory}, {type: summary}]\nruntime: {mode: " +
                             std::get<0>(GetParam()) + ", validate: " + wrong().validate + "}\n");
  }
  static std::string segmenter_for_propagator() {
    return wrong().kind == std::string("propagator") ? "{type: wrong, how: right}" : "";
  }

  const TemporaryFolder folder_;
};

TEST_P(WrongResults, EndTheRunWithTheStageThatGaveThem) {
  const fs::path out = folder_.path() / "out";
  const Outcome outcome = call({"run", pipeline().string(), "-o", out.string()},
                               {.environment = {{"STILLPOINT_PLUGIN_PATH", kBadPlugins.string()}}});
  EXPECT_EQ(outcome.exit_code, kStageFailed) << outcome.signal;
  const std::string message = std::string(wrong().role) + " (wrong) failed on frame 3: ";
  EXPECT_THAT(outcome.err, HasSubstr("error: " + message));
  EXPECT_THAT(outcome.err, HasSubstr(wrong().problem));
  EXPECT_GE(count_poses(out / "trajectory.txt"), 3u);
  const auto summary = json_file(out / "summary.json");
  EXPECT_FALSE(summary["complete"]);
  EXPECT_THAT(summary["failure"].get<std::string>(), ::testing::StartsWith(message));
}

INSTANTIATE_TEST_SUITE_P(Cases, WrongResults,
                         ::testing::Combine(::testing::Values("inline", "threaded"),
                                            ::testing::ValuesIn(kWrongs)),
                         [](const auto& test) {
                           const Wrong& wrong = std::get<1>(test.param);
                           return std::string(std::get<0>(test.param)) + "_" + wrong.kind + "_" +
                                  wrong.how;
                         });

TEST(WrongResultsAtTheEnd, ASourceWithoutFramesIsSaid) {
  const TemporaryFolder folder;
  const fs::path pipeline = folder.write("empty.yaml",
                                         "version: 1\nsource: {type: wrong, how: no_frames}\n"
                                         "tracker: {type: wrong, how: right}\n");
  const Outcome outcome = call({"run", pipeline.string(), "-o", (folder.path() / "out").string()},
                               {.environment = {{"STILLPOINT_PLUGIN_PATH", kBadPlugins.string()}}});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: the source gave no frame"));
}

}  // namespace
}  // namespace stillpoint::testing
