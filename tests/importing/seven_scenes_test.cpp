#include "importing/fixtures.hpp"

namespace stillpoint::importing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class SevenScenesTest : public ::testing::Test {
 protected:
  void write(int number, const cv::Mat& depth, cv::Size color_size = {640, 480}) {
    write_image(file(number, "color.png"), flat_color(color_size));
    write_image(file(number, "depth.png"), depth);
    write_pose(number, matrix_text(some_pose(number).matrix()));
  }
  void write_pose(int number, const std::string& text) {
    folder.write(file(number, "pose.txt").filename().string(), text);
  }
  fs::path file(int number, const std::string& ending) const {
    char name[64];
    std::snprintf(name, sizeof(name), "frame-%06d.%s", number, ending.c_str());
    return folder.path() / name;
  }
  std::string refused(const ImportOptions& options = {}) {
    return refusal([&] { Imported{folder.path(), options}; });
  }

  TemporaryFolder folder;
};

TEST_F(SevenScenesTest, DepthMovesFromItsCameraIntoThatOfColour) {
  cv::Mat depth = flat_depth(2000);
  depth(cv::Rect(400, 0, 100, 480)).setTo(3000);
  depth(cv::Rect(500, 0, 140, 480)).setTo(65535);  // not measured
  write(0, depth);
  const Imported imported(folder.path());
  EXPECT_EQ(imported.camera.fx, 525);
  EXPECT_EQ(imported.metres(0, 320, 240), 2.0);
  EXPECT_EQ(imported.metres(0, 10, 240), 0.0);  // the colour camera sees more
  const double edge = 320 + (399.5 - 320) * 525 / 585;
  EXPECT_EQ(imported.metres(0, static_cast<int>(edge), 240), 2.0);
  EXPECT_EQ(imported.metres(0, static_cast<int>(edge) + 1, 240), 3.0);
  EXPECT_EQ(imported.metres(0, 550, 240), 0.0);
  EXPECT_THAT(imported.notes, Contains(HasSubstr("moved from the depth camera")));
}

TEST_F(SevenScenesTest, TimesAndPosesAreThoseOfTheNumbers) {
  for (const int number : {0, 1, 5}) write(number, flat_depth(1000));
  const Imported imported(folder.path());
  ASSERT_EQ(imported.read.pairs.size(), 3u);
  EXPECT_NEAR(imported.read.pairs[2].color.time, 5 / 30.0, 1e-6);
  EXPECT_EQ(cv::norm(imported.color(2), flat_color(), cv::NORM_INF), 0);
  ASSERT_EQ(imported.truth().size(), 3u);
  EXPECT_NEAR(imported.truth()[2].time, 5 / 30.0, 1e-6);
  expect_pose(imported.truth()[2].world_from_camera, some_pose(5));
  EXPECT_EQ(imported.written, 3u);  // depth; colour is linked
}

TEST_F(SevenScenesTest, WithACameraDepthIsTakenForRegistered) {
  const CameraModel small{.name = "small", .width = 64, .height = 48, .depth_factor = 1000};
  cv::Mat depth = flat_depth(1500, {64, 48});
  depth(cv::Rect(0, 0, 10, 48)).setTo(65535);
  write(3, depth, {64, 48});
  const Imported imported(folder.path(), {.camera = small, .camera_is_users = true});
  EXPECT_EQ(imported.metres(0, 63, 47), 1.5);
  EXPECT_EQ(imported.metres(0, 9, 0), 0.0);
  EXPECT_EQ(imported.camera.name, "small");
}

TEST_F(SevenScenesTest, LostPosesAreNoTruth) {
  for (int number = 0; number < 5; ++number) write(number, flat_depth(1000));
  const std::string rest = " 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1";
  write_pose(0, "-inf" + rest);
  write_pose(1, "nan" + rest);
  write_pose(2, "-1.#IND" + rest);
  fs::remove(file(3, "pose.txt"));
  const Imported imported(folder.path());
  ASSERT_EQ(imported.truth().size(), 1u);
  expect_pose(imported.truth()[0].world_from_camera, some_pose(4));
  EXPECT_THAT(imported.notes, Contains("4 of 5 images have no true pose"));
}

TEST_F(SevenScenesTest, WhatDoesNotFitIsNamed) {
  write(0, flat_depth(1000, {320, 240}));
  EXPECT_THAT(refused(), HasSubstr("frame-000000.depth.png: is 320 x 240 pixels, the camera "
                                   "'seven_scenes' has 640 x 480"));
  write(0, flat_depth(1000), {320, 240});
  EXPECT_THAT(refused(), HasSubstr("frame-000000.color.png: is 320 x 240 pixels"));
  write(0, flat_depth(1000));
  write_pose(0, "1 0 0 zero");
  EXPECT_THAT(refused(), HasSubstr("frame-000000.pose.txt: is no 4 x 4 matrix of numbers"));
  write_pose(0, "1 0 0");
  EXPECT_THAT(refused(), HasSubstr("holds 3 numbers instead of 16"));
  fs::remove(file(0, "pose.txt"));
  fs::remove(file(0, "depth.png"));
  EXPECT_THAT(refused(), HasSubstr("frame-000000.depth.png: no such file"));
}

}  // namespace
}  // namespace stillpoint::importing
