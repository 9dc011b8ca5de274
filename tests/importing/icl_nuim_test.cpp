#include "importing/icl_nuim.hpp"

#include "importing/fixtures.hpp"

namespace stillpoint::importing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class IclNuimTest : public ::testing::Test {
 protected:
  void write(int count) {
    std::string associations, truth;
    for (int i = 0; i < count; ++i) {
      const std::string number = std::to_string(i);
      write_image(folder.path() / ("rgb/" + number + ".png"), flat_color());
      write_image(folder.path() / ("depth/" + number + ".png"), flat_depth(5000 + i));
      associations += number + " depth/" + number + ".png " + number + " rgb/" + number + ".png\n";
      if (i > 0) truth += pose_text(number, some_pose(i));  // image 0 has none
    }
    folder.write("associations.txt", associations);
    folder.write("livingRoom0.gt.freiburg", truth);
  }
  TemporaryFolder folder;
};

TEST_F(IclNuimTest, ImagesStayAndNumbersAreTimes) {
  write(4);
  const Imported imported(folder.path());
  ASSERT_EQ(imported.read.pairs.size(), 4u);
  EXPECT_NEAR(imported.read.pairs[3].color.time, 0.1, 1e-6);
  EXPECT_NEAR(imported.metres(3, 1, 1), 5003 / 5000.0, 1e-9);
  EXPECT_EQ(imported.written, 0u);
  EXPECT_EQ(fs::hard_link_count(folder.path() / "rgb/3.png"), 2u);
  ASSERT_EQ(imported.truth().size(), 3u);
  EXPECT_NEAR(imported.truth()[0].time, 1 / 30.0, 1e-6);
}

// The data set: world and camera with y up, fy = -480. A point of the world must stay at its pixel.
TEST_F(IclNuimTest, PosesFitTheImages) {
  write(3);
  const Imported imported(folder.path());
  const Camera camera = imported.camera.undistorted();
  for (int i = 1; i < 3; ++i) {
    const Pose pose = imported.truth().at(static_cast<std::size_t>(i - 1)).world_from_camera;
    for (const Eigen::Vector3d& in_camera : {Eigen::Vector3d(0.3, 0.4, 2), {-0.5, 0.1, 3}}) {
      const Eigen::Vector2d pixel(481.2 * in_camera.x() / in_camera.z() + 319.5,
                                  -480 * in_camera.y() / in_camera.z() + 239.5);
      Eigen::Vector3d point = some_pose(i) * in_camera;
      point.y() = -point.y();  // the world with y down
      EXPECT_LT((camera.project(pose.inverse() * point) - pixel).norm(), 1e-2);
    }
  }
}

TEST_F(IclNuimTest, GoesWithoutTruth) {
  write(2);
  fs::remove(folder.path() / "livingRoom0.gt.freiburg");
  const Imported imported(folder.path());
  EXPECT_TRUE(imported.read.ground_truth.empty());
  EXPECT_THAT(imported.notes, ElementsAre(HasSubstr("no *.gt.freiburg")));
}

TEST_F(IclNuimTest, WhatIsWrongIsNamed) {
  write(2);
  const auto refused = [this] { return refusal([this] { Imported{folder.path()}; }); };
  fs::remove(folder.path() / "rgb/1.png");
  EXPECT_THAT(refused(), HasSubstr("rgb/1.png: no such image"));
  write(2);
  folder.write("livingRoom0.gt.freiburg", "1 0 0 0 0 0 0 1\n2 0 0 nan 0 0 0 1\n");
  EXPECT_THAT(refused(), HasSubstr("livingRoom0.gt.freiburg:2: is no pose"));
  write(2);
  write_image(folder.path() / "depth/0.png", flat_depth(1, {320, 240}));
  EXPECT_THAT(refused(), HasSubstr("depth/0.png: is 320 x 240 pixels"));
  folder.write("associations.txt", "0 depth/0.png\n");
  EXPECT_THAT(refused(), HasSubstr("associations.txt:1: found 2 columns"));
}

class IclNuimRawTest : public ::testing::Test {
 protected:
  /// A wall 2 m in front of the camera, which looks along some direction.
  void write(const std::string& stem, double units_per_metre) {
    write_image(folder.path() / (stem + ".png"), flat_color());
    std::string distances;
    for (int y = 0; y < 480; ++y)
      for (int x = 0; x < 640; ++x) {
        const Eigen::Vector3d ray((x - 319.5) / 481.2, (y - 239.5) / 480, 1);
        distances += std::to_string(2 * units_per_metre * ray.norm()) + ' ';
      }
    folder.write(stem + ".depth", distances);
    const Pose pose = some_pose(2);
    folder.write(stem + ".txt", line("cam_pos", units_per_metre * pose.translation()) +
                                    line("cam_dir", pose.linear().col(2)) +
                                    line("cam_up", pose.linear().col(1)) +
                                    line("cam_lookat", {0, 0, 1}));
  }
  static std::string line(const std::string& key, const Eigen::Vector3d& v) {
    char text[128];
    std::snprintf(text, sizeof(text), "%-12s = [%.9f, %.9f, %.9f]';\n", key.c_str(), v.x(), v.y(),
                  v.z());
    return text;
  }
  void expect_wall(double time) const {
    const Imported imported(folder.path());
    for (const cv::Point pixel : {cv::Point(0, 0), cv::Point(320, 240), cv::Point(639, 100)})
      EXPECT_EQ(imported.metres(0, pixel.x, pixel.y), 2.0);
    EXPECT_NEAR(imported.read.pairs.at(0).color.time, time, 1e-6);
    // As the same pose in the other form of the data set.
    expect_pose(imported.truth().at(0).world_from_camera, mirrored_in_y(some_pose(2)));
  }
  TemporaryFolder folder;
};

TEST_F(IclNuimRawTest, DistancesBecomeDepth) {
  write("scene_00_0003", 1);
  expect_wall(0.1);
}

TEST_F(IclNuimRawTest, TheOfficeIsInCentimetres) {
  write("scene_006", 100);
  expect_wall(0.2);
}

TEST_F(IclNuimRawTest, WhatIsWrongIsNamed) {
  write("scene_00_0000", 1);
  const auto refused = [this] { return refusal([this] { Imported{folder.path()}; }); };
  folder.write("scene_00_0000.depth", "1 2 3\n");
  EXPECT_THAT(refused(), HasSubstr("scene_00_0000.depth: holds 3 numbers, the camera 'icl_nuim' "
                                   "has 640 x 480 pixels"));
  folder.write("scene_00_0000.depth", "1 2 three\n");
  EXPECT_THAT(refused(), HasSubstr("scene_00_0000.depth: is no text of numbers"));
  folder.write("scene_00_0000.txt", "cam_dir = [0, 0, 1]';\n");
  EXPECT_THAT(refused(), HasSubstr("scene_00_0000.txt: has no vector cam_up"));
  fs::remove(folder.path() / "scene_00_0000.txt");
  EXPECT_THAT(refused(), HasSubstr("scene_00_0000.txt: no such file"));
}

}  // namespace
}  // namespace stillpoint::importing
