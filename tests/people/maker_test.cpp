#include "people/maker.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "small_base.hpp"
#include "support/image_io.hpp"

namespace stillpoint::people {
namespace {

namespace fs = std::filesystem;

class MakerTest : public ::testing::Test {
 protected:
  Coverage make(const RecordingPlan& plan, const std::string& out, double wall = 4,
                int threads = 1) {
    const fs::path folder = folder_.path() / ("base" + std::to_string(wall));
    if (!fs::exists(folder)) plan_ = write_base(folder, 6, wall);
    plan_.folder = folder;
    const BaseRecording base(plan_, small_camera());
    return make_recording(plan, base, {.people = {photo_}, .pictures = {}}, folder_.path() / out,
                          threads);
  }
  cv::Mat image(const std::string& name) const {
    return testing::read_image(folder_.path() / name / "1.200000.png", cv::IMREAD_UNCHANGED);
  }
  /// Every file of a recording, by name.
  std::map<std::string, std::string> bytes(const std::string& out) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path() / out)) {
      if (!entry.is_regular_file()) continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      files[fs::relative(entry.path(), folder_.path() / out)] = text.str();
    }
    return files;
  }

  testing::TemporaryFolder folder_;
  PersonPhoto photo_ = write_person(folder_);
  BasePlan plan_;
};

/// Crosses the picture at 2 m.
RecordingPlan crossing(int seed = 1) {
  return {.name = "crossing",
          .seed = seed,
          .people = {{.walk = {0, -0.5, 2, 1, 0.5, 2}, .height = 1.8}}};
}

TEST_F(MakerTest, LabelsAreWhatWasPasted) {
  const Coverage coverage = make(crossing(), "out");
  const cv::Mat labels = image("out/labels"), depth = image("out/depth"), bgr = image("out/rgb");
  cv::Mat change;
  cv::absdiff(bgr, cv::Mat(bgr.size(), CV_8UC3, cv::Scalar::all(90)), change);
  cv::extractChannel(change, change, 2);
  const cv::Mat person = labels == 15;
  EXPECT_GT(cv::countNonZero(person), 1000);
  EXPECT_EQ(cv::countNonZero(person & (change < 20)), 0);
  cv::Mat around;
  cv::dilate(person, around, cv::Mat::ones(5, 5, CV_8U));
  EXPECT_EQ(cv::countNonZero(~around & (change > 3)), 0);
  // 2 m, less 0.07 heights of relief; who is aside of the middle stands turned to the camera.
  EXPECT_EQ(cv::countNonZero(person & (depth > 0) & ((depth < 8950) | (depth > 10400))), 0);
  EXPECT_EQ(cv::countNonZero(~person & (depth > 0) & (depth != 20000)), 0);
  EXPECT_EQ(coverage.frames, 6);
  EXPECT_NEAR(coverage.max, cv::countNonZero(person) / static_cast<double>(person.total()), 0.02);
}

TEST_F(MakerTest, WhatIsNearerHidesPeople) {
  EXPECT_EQ(make(crossing(), "out", 1.5).max, 0);
  EXPECT_EQ(cv::countNonZero(image("out/labels")), 0);
  EXPECT_EQ(cv::countNonZero(image("out/depth") != 7500), 0);
}

TEST_F(MakerTest, TheSamePlanGivesTheSameBytes) {
  make(crossing(), "one", 4, 1);
  make(crossing(), "again", 4, 3);
  make(crossing(2), "other", 4, 1);
  EXPECT_EQ(bytes("one").size(), 4 * 6 + 4U);  // images, lists and ground truth
  EXPECT_EQ(bytes("one"), bytes("again"));
  EXPECT_NE(bytes("one"), bytes("other"));
}

TEST_F(MakerTest, ADeskIsLabelledByItsHeight) {
  plan_ = write_base(folder_.path() / "base", 3, 2);
  plan_.desk = {1.0, 1.3};
  const BaseRecording base(plan_, small_camera());
  make_recording({.name = "empty"}, base, {}, folder_.path() / "out", 1);
  const cv::Mat labels = image("out/labels");
  // Of the wall at 2 m, 0.1 to 0.4 m below the camera.
  EXPECT_NEAR(cv::boundingRect(labels == 11).y, 60 + 134 * 0.1 / 2, 1);
  EXPECT_NEAR(cv::boundingRect(labels == 11).br().y, 60 + 134 * 0.4 / 2, 1);
}

TEST_F(MakerTest, APartThatIsNotThereIsAFault) {
  RecordingPlan plan = crossing();
  plan.first = 6;
  EXPECT_THROW(make(plan, "out"), Error);
}

}  // namespace
}  // namespace stillpoint::people
