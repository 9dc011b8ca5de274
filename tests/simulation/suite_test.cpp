#include "simulation/suite.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "simulation/renderer.hpp"
#include "simulation/simulator.hpp"
#include "small_camera.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3d;

SceneOptions suite() {
  SceneOptions scene;
  scene.room.plan = RoomOptions::Plan::kSuite;
  scene.sensor.ideal = true;
  scene.motion.jitter = 0;
  return scene;
}

cv::Mat view(const World& world, const Vector3d& eye, const Vector3d& target) {
  MotionOptions motion;
  motion.kind = MotionOptions::Kind::kStatic;
  motion.jitter = 0;
  motion.position = {eye.x(), eye.y(), eye.z()};
  motion.look_at = {target.x(), target.y(), target.z()};
  const CameraMotion still(motion, 1);
  Renderer renderer(world, still, small_camera().undistorted(), 2);
  return renderer.render(0, 0).color;
}

// Mean difference of the left walls of the second and the fourth room of a column, grey levels;
// without the floor, whose pattern goes through all rooms.
double difference_of_two_rooms(bool alike) {
  SceneOptions scene = suite();
  scene.room.alike = alike;
  const World world = build_world(scene);
  const Vector3d between(0, 12, 0), eye(-1.5, -6, 1.5), wall(-6, -6, 1.7);
  cv::Mat difference;
  cv::absdiff(view(world, eye, wall), view(world, eye + between, wall + between), difference);
  const cv::Scalar mean = cv::mean(difference.rowRange(0, 80));
  return (mean[0] + mean[1] + mean[2]) / 3;
}

TEST(Suite, RoomsAreAlikeOnRequestOnly) {
  EXPECT_LT(difference_of_two_rooms(true), 8);  // light is sampled
  EXPECT_GT(difference_of_two_rooms(false), 12);
}

// Through the first doorway one sees farther than the room is wide.
TEST(Suite, DoorwaysLeadFromRoomToRoom) {
  SceneOptions scene = suite();
  scene.motion.kind = MotionOptions::Kind::kStatic;
  scene.motion.position = {-4.2, -12, 1.4};
  scene.motion.look_at = {-4.2, -9, 1.4};
  const CameraModel camera = small_camera();
  const SimulatedFrame frame = Simulator(scene, camera, 2).frame(0);
  const auto metres = [&](int x) {
    return frame.depth.at<std::uint16_t>(60, x) / camera.depth_factor;
  };
  EXPECT_GT(metres(80), 4.0);           // the doorway, 1.5 m wide
  EXPECT_NEAR(metres(130), 2.94, 0.5);  // the wall beside it, or what stands before it
}

TEST(Suite, AWalkLooksAheadAndComesBack) {
  SceneOptions scene = suite();
  scene.motion.kind = MotionOptions::Kind::kWalk;
  scene.motion.path = {-3, -3, 3, -3, 3, 3, -3, 3};
  const CameraMotion motion(scene.motion, 1);
  const double turn = WalkingPath(scene.motion.path).length() / 0.9;  // seconds at 0.9 m/s
  EXPECT_LT(
      (motion.world_from_camera(0).translation() - motion.world_from_camera(turn).translation())
          .norm(),
      0.05);
  for (double t = 0; t < turn; t += 0.5) {
    const Pose now = motion.world_from_camera(t);
    const Vector3d step = motion.world_from_camera(t + 0.1).translation() - now.translation();
    EXPECT_NEAR(step.norm(), 0.09, 0.02);
    EXPECT_GT(now.linear().col(2).dot(step.normalized()), 0.85) << t;  // axes: z is forward
    EXPECT_NEAR(now.translation().z(), scene.motion.position[2], 1e-9);
  }
}

}  // namespace
}  // namespace stillpoint::simulation
