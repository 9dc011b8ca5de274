#include "simulation/simulator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "small_camera.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::simulation {
namespace {

SceneOptions scene_with_people() {
  SceneOptions scene;
  PersonOptions walker;
  walker.path = {-1.2, 0, 1.2, 0.1, 0, 0.4};
  walker.start = 1.0;
  PersonOptions sitter;
  sitter.pose = PersonOptions::Pose::kSit;
  sitter.path = {0.95, 0.22};
  sitter.heading = 140;
  scene.people = {walker, sitter};
  scene.balls = {{}};
  return scene;
}

SceneOptions emptied(SceneOptions scene) {
  scene.people.clear();
  scene.balls.clear();
  return scene;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         cv::norm(a.reshape(1), b.reshape(1), cv::NORM_INF) == 0;
}

void expect_same(const SimulatedFrame& a, const SimulatedFrame& b) {
  EXPECT_TRUE(same(a.bgr, b.bgr));
  EXPECT_TRUE(same(a.depth, b.depth));
  EXPECT_TRUE(same(a.labels, b.labels));
  EXPECT_TRUE(same(a.instances, b.instances));
  EXPECT_TRUE(a.world_from_camera.isApprox(b.world_from_camera, 0));
}

TEST(Simulator, SameBytesWithAnyNumberOfThreadsAndInAnyOrder) {
  Simulator one(scene_with_people(), small_camera(), 1);
  Simulator two(scene_with_people(), small_camera(), 2);
  one.frame(0);
  const SimulatedFrame from_one = one.frame(7);
  expect_same(from_one, two.frame(7));
  two.frame(3);
  expect_same(from_one, two.frame(7));
}

TEST(Simulator, AnotherSeedGivesOtherNoise) {
  SceneOptions scene = scene_with_people();
  scene.motion.jitter = 0;
  Simulator one(scene, small_camera(), 1);
  scene.seed = 2;
  Simulator two(scene, small_camera(), 1);
  EXPECT_FALSE(same(one.frame(0).bgr, two.frame(0).bgr));
  EXPECT_FALSE(same(one.frame(0).depth, two.frame(0).depth));
}

TEST(Simulator, DepthIsThatOfTheGeometry) {
  SceneOptions scene;
  scene.room.furnished = false;
  scene.sensor.ideal = true;
  scene.motion.kind = MotionOptions::Kind::kRpy;
  const CameraModel model = small_camera();
  Simulator simulator(scene, model, 1);
  const SimulatedFrame frame = simulator.frame(40);
  const Camera camera = model.undistorted();
  int at_back = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double depth = frame.depth.at<std::uint16_t>(y, x) / model.depth_factor;
      const Eigen::Vector3d point = frame.world_from_camera * camera.unproject(x, y, depth);
      // The walls, floor and ceiling, or the lamps 3 cm below the ceiling.
      const double to_wall =
          std::min({std::abs(point.y() - 4.0), std::abs(std::abs(point.x()) - 3.2),
                    std::abs(point.y() + 3.6), std::abs(point.z()), std::abs(point.z() - 2.9),
                    std::abs(point.z() - 2.87)});
      ASSERT_LT(to_wall, 3e-4) << x << ' ' << y;
      at_back += std::abs(point.y() - 4.0) < 3e-4 ? 1 : 0;
    }
  }
  EXPECT_GT(at_back, 1000);
}

double contrast(const SceneOptions& scene) {
  Simulator simulator(scene, small_camera(), 1);
  cv::Scalar mean, deviation;
  cv::Mat gray;
  cv::cvtColor(simulator.frame(0).bgr, gray, cv::COLOR_BGR2GRAY);
  cv::Mat fine = cv::Mat(gray.size(), CV_32F), smooth;
  gray.convertTo(fine, CV_32F);
  cv::GaussianBlur(fine, smooth, {}, 3);
  cv::meanStdDev(fine - smooth, mean, deviation);
  return deviation[0];
}

TEST(Simulator, WithoutTextureSurfacesAreOfOneColour) {
  SceneOptions scene;
  scene.room.furnished = false;
  scene.sensor.ideal = true;
  scene.motion.kind = MotionOptions::Kind::kStatic;
  scene.motion.position = {0, 0, 1.4};
  scene.motion.look_at = {0, 1, 0};  // the floor
  const double usual = contrast(scene);
  scene.room.texture = 0.0;
  EXPECT_LT(contrast(scene), 0.5 * usual);
}

TEST(Simulator, ACorridorIsTwoMetresWide) {
  SceneOptions scene;
  scene.room.plan = RoomOptions::Plan::kCorridor;
  scene.room.furnished = false;
  scene.sensor.ideal = true;
  scene.motion.kind = MotionOptions::Kind::kStatic;
  scene.motion.position = {0, 5, 1.4};
  scene.motion.look_at = {0, 8, 1.2};
  const CameraModel model = small_camera();
  Simulator simulator(scene, model, 1);
  const SimulatedFrame frame = simulator.frame(0);
  const Camera camera = model.undistorted();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double depth = frame.depth.at<std::uint16_t>(y, x) / model.depth_factor;
      if (depth == 0) continue;
      const Eigen::Vector3d point = frame.world_from_camera * camera.unproject(x, y, depth);
      const double to_surface = std::min({std::abs(std::abs(point.x()) - 1.0), std::abs(point.z()),
                                          std::abs(point.z() - 2.7), std::abs(point.y() - 15.0)});
      ASSERT_LT(to_surface, 3e-3) << x << ' ' << y;
    }
  }
}

TEST(Simulator, PoseAndStampBelongToTheMiddleOfTheExposure) {
  SceneOptions scene;
  scene.start_time = 1341846434;
  Simulator simulator(scene, small_camera(), 1);
  EXPECT_DOUBLE_EQ(simulator.stamp(1), 1341846434.033333);
  const CameraMotion motion(scene.motion, scene.seed);
  const Pose expected = motion.world_from_camera(simulator.stamp(1) - scene.start_time);
  EXPECT_TRUE(simulator.frame(1).world_from_camera.isApprox(expected, 1e-12));
  EXPECT_EQ(simulator.frame(1).depth_time, simulator.frame(1).time);
}

TEST(Simulator, DepthOffsetRollsOverAtHalfAFrame) {
  SceneOptions scene;
  scene.sensor.depth_offset = 0.010;
  scene.sensor.depth_offset_drift = 0.01;
  const Simulator simulator(scene, small_camera(), 1);
  EXPECT_NEAR(simulator.depth_stamp(0) - simulator.stamp(0), 0.010, 2e-6);
  EXPECT_NEAR(simulator.depth_stamp(15) - simulator.stamp(15), 0.015, 2e-6);
  EXPECT_NEAR(simulator.depth_stamp(30) - simulator.stamp(30), 0.020 - 1 / 30.0, 2e-6);
}

TEST(Simulator, LabelsAndInstancesAgree) {
  Simulator simulator(scene_with_people(), small_camera(), 1);
  const SimulatedFrame frame = simulator.frame(0);
  std::array<int, 256> label_of_instance{};
  label_of_instance.fill(-1);
  for (int y = 0; y < frame.labels.rows; ++y) {
    for (int x = 0; x < frame.labels.cols; ++x) {
      const std::uint8_t label = frame.labels.at<std::uint8_t>(y, x);
      const std::uint8_t instance = frame.instances.at<std::uint8_t>(y, x);
      ASSERT_TRUE(label == 0 || instance != 0);
      if (instance == 0) continue;
      if (label_of_instance[instance] < 0) label_of_instance[instance] = label;
      EXPECT_EQ(label_of_instance[instance], label);
    }
  }
  EXPECT_EQ(std::count(label_of_instance.begin(), label_of_instance.end(), kPerson), 2);
  EXPECT_GT(cv::countNonZero(frame.labels == kPerson), 500);
  EXPECT_GT(cv::countNonZero(frame.labels == kTvMonitor), 50);
}

TEST(Simulator, WithoutPeopleTheRestIsTheSame) {
  Simulator full(scene_with_people(), small_camera(), 1);
  Simulator empty(emptied(scene_with_people()), small_camera(), 1);
  const SimulatedFrame a = full.frame(5);
  const SimulatedFrame b = empty.frame(5);
  EXPECT_EQ(cv::countNonZero(b.labels == kPerson), 0);
  EXPECT_TRUE(a.world_from_camera.isApprox(b.world_from_camera, 0));
  // Instances of people and the ball come after those of the room.
  double most = 0;
  cv::minMaxLoc(b.instances, nullptr, &most);
  cv::Mat moving = a.instances > most;
  cv::Mat near;
  cv::dilate(moving, near, cv::Mat::ones(25, 25, CV_8U));
  ASSERT_GT(cv::countNonZero(near == 0), 4000);
  cv::Mat difference;
  cv::absdiff(a.bgr, b.bgr, difference);
  difference.setTo(cv::Scalar::all(0), near);
  EXPECT_EQ(cv::countNonZero(difference.reshape(1)), 0);
}

TEST(Simulator, RefusesADistortedCamera) {
  CameraModel camera = small_camera();
  camera.distortion = {0.1, 0, 0, 0};
  try {
    Simulator(SceneOptions{}, camera, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("distortion"));
  }
}

}  // namespace
}  // namespace stillpoint::simulation
