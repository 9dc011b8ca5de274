// Recordings in which something is wrong: what the program says, and what it saves all the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kFrames = 12;
constexpr int kBad = 5;  // the image with a fault; the others are fine
constexpr int kUnusableData = 3;

class BadRecording : public ::testing::Test {
 protected:
  Outcome run() const { return run(recording_.path()); }
  Outcome run(const fs::path& dataset) const {
    return call({"run", "orb_baseline", "--dataset", dataset.string(), "-o", out().string()});
  }
  // One image is skipped, named and counted, and the run goes on.
  void expect_skipped(const fs::path& image, const std::string& reason) const {
    const Outcome outcome = run();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("skipped: " + image.string() + ": "));
    EXPECT_THAT(outcome.err, HasSubstr(reason));
    EXPECT_THAT(outcome.out, HasSubstr("1 image left out"));
    const auto summary = json_file(out() / "summary.json");
    EXPECT_TRUE(summary["complete"]);
    EXPECT_EQ(summary["skipped_images"], 1);
    EXPECT_THAT(summary["warnings"].dump(), HasSubstr(image.filename().string()));
    EXPECT_EQ(count_poses(out() / "trajectory.txt"), kFrames - 1u);
  }
  void expect_refused(const fs::path& dataset, const std::string& message) const {
    const Outcome outcome = run(dataset);
    EXPECT_EQ(outcome.exit_code, kUnusableData) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("error: source (tum_rgbd): "));
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
  void expect_refused(const std::string& message) const {
    expect_refused(recording_.path(), message);
  }
  std::string at(const std::string& name) const { return (recording_.path() / name).string(); }
  fs::path out() const { return folder_.path() / "out"; }

  const RecordingCopy recording_{kFrames};
  const TemporaryFolder folder_;
};

TEST_F(BadRecording, MissingFolder) {
  expect_refused(
      folder_.path() / "nowhere",
      "nowhere: no such folder; give the folder that holds rgb.txt and depth.txt, or a bag "
      "(.bag, .mcap, .db3)");
}
TEST_F(BadRecording, FileInsteadOfAFolder) {
  expect_refused(recording_.path() / "rgb.txt", "rgb.txt: is not a folder; give the folder");
}
TEST_F(BadRecording, MissingLists) {
  fs::remove(at("depth.txt"));
  expect_refused(
      "has rgb.txt but no depth.txt; a recording is a folder in the format of the TUM RGB-D");
  fs::remove(at("rgb.txt"));
  expect_refused("has neither rgb.txt and depth.txt nor associations.txt");
}
TEST_F(BadRecording, EmptyList) {
  recording_.write("rgb.txt", "# timestamp filename\n");
  expect_refused(at("rgb.txt") + ": lists no images; expected lines of a time stamp and a file");
}
TEST_F(BadRecording, OneColumn) {
  recording_.write("depth.txt", recording_.read("depth.txt") + "1000.9\n");
  expect_refused(at("depth.txt") + ":" + std::to_string(kFrames + 3) +
                 ": found one column, '1000.9'; expected a time stamp and a file name");
}
TEST_F(BadRecording, StampIsNoNumber) {
  recording_.write("rgb.txt", "soon rgb/1000.000000.png\n");
  expect_refused(at("rgb.txt") + ":1: 'soon' is not a time stamp; expected seconds");
}
TEST_F(BadRecording, StreamsOfDifferentTimes) {
  recording_.write("depth.txt", "2000.0 " + recording_.depth(0).string() + "\n");
  expect_refused("no colour image has a depth image within 0.02");
}

// Both are repaired, with a warning: the result is that of the tidy list.
TEST_F(BadRecording, UnsortedAndRepeatedStamps) {
  recording_.write("rgb.txt", recording_.read("rgb.txt") + "1000.033333 rgb/1000.000000.png\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(at("rgb.txt") + ": time stamps are not in order; sorted"));
  EXPECT_THAT(outcome.err, HasSubstr("1 repeated time stamps; the first image of each is used"));
  EXPECT_EQ(count_poses(out() / "trajectory.txt"), std::size_t{kFrames});
}

TEST_F(BadRecording, MissingImageIsSkipped) {
  fs::remove(recording_.color(kBad));
  expect_skipped(recording_.color(kBad), "no such file");
}
TEST_F(BadRecording, TruncatedImageIsSkipped) {
  truncate_file(recording_.depth(kBad), 0.5);
  expect_skipped(recording_.depth(kBad), "truncated");
}
TEST_F(BadRecording, EmptyImageIsSkipped) {
  truncate_file(recording_.color(kBad), 0.0);
  expect_skipped(recording_.color(kBad), "the file is empty");
}
TEST_F(BadRecording, TextInsteadOfAnImageIsSkipped) {
  recording_.write("rgb/" + recording_.color(kBad).filename().string(), "this is no image\n");
  expect_skipped(recording_.color(kBad), "is not an image");
}
TEST_F(BadRecording, DepthOfEightBitsIsSkipped) {
  recording_.replace(recording_.depth(kBad), cv::Mat(480, 640, CV_8UC1, cv::Scalar(100)));
  expect_skipped(recording_.depth(kBad), "a depth image must be 16-bit with 1 channel");
}
TEST_F(BadRecording, ImageOfAnotherSizeIsSkipped) {
  recording_.replace(recording_.color(kBad), cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(90)));
  expect_skipped(recording_.color(kBad), "the image has 320 x 240 pixels, but camera 'simulated'");
}
TEST_F(BadRecording, DepthWithoutAnyMeasurementIsSkipped) {
  recording_.replace(recording_.depth(kBad), cv::Mat::zeros(480, 640, CV_16UC1));
  expect_skipped(recording_.depth(kBad), "the depth image has no measurement");
}

TEST_F(BadRecording, NothingUsableNamesAnImageAndARemedy) {
  recording_.write("rgb.txt", recording_.read("depth.txt"));  // the wrong way round
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, kUnusableData);
  EXPECT_THAT(outcome.err, HasSubstr("more than half of the 12 image pairs cannot be used"));
  EXPECT_THAT(outcome.err,
              HasSubstr("the last one: " + recording_.depth(0).parent_path().string()));
  EXPECT_THAT(outcome.err, HasSubstr("check that colour and depth are not exchanged"));
}

TEST_F(BadRecording, WhatWasComputedIsSavedWhenTooMuchIsMissing) {
  for (int frame = kBad; frame < kFrames; ++frame) fs::remove(recording_.color(frame));
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, kUnusableData);
  EXPECT_THAT(outcome.err, HasSubstr("more than half of the 12 image pairs cannot be used"));
  EXPECT_EQ(count_poses(out() / "trajectory.txt"), std::size_t{kBad});
  const auto summary = json_file(out() / "summary.json");
  EXPECT_FALSE(summary["complete"]);
  EXPECT_THAT(summary["failure"].get<std::string>(), HasSubstr("source (tum_rgbd) failed"));
}

TEST_F(BadRecording, GroundTruthThatIsNoNumberNamesFileAndLine) {
  ASSERT_EQ(run().exit_code, 0);
  recording_.write("groundtruth.txt", "# truth\n1000.0 0 0 0 0 0 0 1\n1000.1 nan 0 0 0 0 0 1\n");
  const Outcome outcome = call({"evaluate", "--reference", at("groundtruth.txt"), "--estimate",
                                (out() / "trajectory.txt").string()});
  EXPECT_EQ(outcome.exit_code, kUnusableData);
  EXPECT_THAT(outcome.err, HasSubstr(at("groundtruth.txt") + ":3: 'nan' is not a finite number"));
  EXPECT_THAT(outcome.err, HasSubstr("leave out poses that are not known"));
}

TEST_F(BadRecording, InspectNamesWhatIsWrong) {
  truncate_file(recording_.depth(kBad), 0.5);
  fs::remove(recording_.color(kBad + 1));
  const Outcome outcome = call({"inspect", recording_.path().string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("warning: 2 of 20 sampled images cannot be used; first: " +
                                     recording_.depth(kBad).string() + ": truncated PNG"));
  const Outcome missing = call({"inspect", at("nowhere")});
  EXPECT_EQ(missing.exit_code, kUnusableData);
  EXPECT_THAT(missing.err, HasSubstr(at("nowhere") + ": no such folder; give the folder"));
}

}  // namespace
}  // namespace stillpoint::testing
