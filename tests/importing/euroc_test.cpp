#include "importing/fixtures.hpp"

namespace stillpoint::importing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t kFirst = 1'403'636'579'763'555'584;  // ns
constexpr std::int64_t kStep = 50'000'000;

constexpr const char* kSensor =
    "%YAML:1.0\n# General sensor definitions.\nsensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n"
    "  data: [0, -1, 0, 0.1,\n         1, 0, 0, 0.2,\n         0, 0, 1, 0.3,\n         0, 0, 0, "
    "1]\n"
    "rate_hz: 20\nresolution: [64, 48]\ncamera_model: pinhole\n"
    "intrinsics: [45.5, 46.5, 31.25, 23.75] #fu, fv, cu, cv\n"
    "distortion_model: radial-tangential\ndistortion_coefficients: [-0.28, 0.07, 0.0002, "
    "1.8e-05]\n";

Pose euroc_body_from_camera() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  pose.translation() << 0.1, 0.2, 0.3;
  return pose;
}

class EurocTest : public ::testing::Test {
 protected:
  void write(int count, const std::string& color = "cam0") {
    const cv::Size size(64, 48);
    std::string list = "#timestamp [ns],filename\r\n", truth = "#timestamp, p_RS_R_x [m], …\n";
    for (int i = 0; i < count; ++i) {
      const std::string stamp = std::to_string(kFirst + kStep * i);
      write_image(at(color + "/data/" + stamp + ".png"), flat_color(size));
      write_image(at("depth0/data/" + stamp + ".png"), flat_depth(2000 + i, size));
      list += stamp + "," + stamp + ".png\r\n";
      truth += pose_text(stamp, some_pose(i), true);
    }
    folder.write("mav0/" + color + "/data.csv", list);
    folder.write("mav0/" + color + "/sensor.yaml", kSensor);
    folder.write("mav0/depth0/data.csv", list);
    folder.write("mav0/state_groundtruth_estimate0/data.csv", truth);
  }
  fs::path at(const std::string& name) const { return folder.path() / "mav0" / name; }
  std::string refused(const ImportOptions& options = {}) {
    return refusal([&] { Imported{folder.path(), options}; });
  }
  TemporaryFolder folder;
};

TEST_F(EurocTest, GivesWhatWasWritten) {
  write(3);
  for (const fs::path& given : {folder.path(), folder.path() / "mav0"}) {
    const Imported imported(given);
    ASSERT_EQ(imported.read.pairs.size(), 3u);
    EXPECT_NEAR(imported.read.pairs[1].color.time, 1403636579.813556, 2e-6);
    EXPECT_EQ(imported.metres(2, 3, 4), 2.002);
    EXPECT_EQ(imported.camera.fy, 46.5);
    EXPECT_THAT(imported.camera.distortion, ElementsAre(-0.28, 0.07, 0.0002, 1.8e-05));
    ASSERT_EQ(imported.truth().size(), 3u);
    expect_pose(imported.truth()[2].world_from_camera, some_pose(2) * euroc_body_from_camera());
    EXPECT_THAT(imported.notes, ElementsAre(HasSubstr("taken for millimetres")));
  }
}

TEST_F(EurocTest, DepthNeedsNoListAndColourMayBeRgb0) {
  write(3, "rgb0");
  fs::remove(at("depth0/data.csv"));
  fs::remove(at("depth0/data/" + std::to_string(kFirst) + ".png"));
  EXPECT_EQ(Imported(folder.path()).read.pairs.size(), 2u);
}

TEST_F(EurocTest, StereoIsRefused) {
  write(2);
  fs::remove_all(at("depth0"));
  fs::create_directories(at("cam1"));
  EXPECT_THAT(refused(),
              HasSubstr("mav0: has no depth images (depth0); this is a stereo recording"));
}

TEST_F(EurocTest, WhatIsWrongIsNamed) {
  write(2);
  folder.write("mav0/cam0/sensor.yaml", "resolution: [64, 48]\nintrinsics: [45.5, 46.5]\n");
  EXPECT_THAT(refused(), HasSubstr("sensor.yaml: resolution and intrinsics cannot be read"));
  folder.write("mav0/cam0/sensor.yaml", "resolution: [64\n");
  EXPECT_THAT(refused(), HasSubstr("sensor.yaml: cannot be understood"));
  std::string fisheye = kSensor;
  fisheye.replace(fisheye.find("radial-tangential"), 17, "equidistant");
  folder.write("mav0/cam0/sensor.yaml", fisheye);
  EXPECT_THAT(refused(), HasSubstr("distortion model 'equidistant' is not supported"));
  fs::remove(at("cam0/sensor.yaml"));
  EXPECT_THAT(refused(),
              HasSubstr("there is no calibration of the camera; name one with --camera"));
  const CameraModel other{.name = "other", .width = 320, .height = 240};
  EXPECT_THAT(refused({.camera = other, .camera_is_users = true}),
              HasSubstr("is 64 x 48 pixels, the camera 'other' has 320 x 240"));
  folder.write("mav0/cam0/data.csv", "1.5,x.png\n");
  EXPECT_THAT(refused(), HasSubstr("data.csv:1: '1.5' is no time in nanoseconds"));
  folder.write("mav0/cam0/data.csv", "#timestamp [ns],filename\n");
  EXPECT_THAT(refused(), HasSubstr("cam0: has no images"));
}

}  // namespace
}  // namespace stillpoint::importing
