#include "orb_slam/appearance.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

class AppearanceTest : public testing::Test {
 protected:
  int locate(ObservedFrame& frame, KeyFrameId by = 0) const {
    return locate_by_appearance(frame, targets_of(*known_.map.keyframe(by), known_.map),
                                known_.map);
  }
  static void expect_at(const ObservedFrame& frame, const Pose& truth) {
    EXPECT_LT(metres_between(frame.world_from_camera, truth), 0.006);
    EXPECT_LT(radians_between(frame.world_from_camera, truth), 0.002);
  }
  TestWorld world_;
  KnownMap known_ = known_map(world_, {world_.render(walk(0)), world_.render(walk(3))});
};

TEST_F(AppearanceTest, FindsThePoseWithoutAGuess) {
  const View view = world_.render(walk(5));
  ObservedFrame frame = observed(view);
  frame.world_from_camera = pose_at({100, 0, 0}, {0, 3, 0});
  EXPECT_GT(locate(frame), 100);
  expect_at(frame, walk(5));
  for (std::uint32_t i = 0; i < view.point.size(); ++i) {
    EXPECT_FALSE(frame.outlier[i]);
    if (frame.landmarks[i] != kNoId) {
      EXPECT_EQ(known_.point[frame.landmarks[i]], view.point[i]);
    }
  }
}

TEST_F(AppearanceTest, AlsoUpsideDown) {
  const Pose upside_down = pose_at({0, 0, 0}, {0, 0, 3.1});
  ObservedFrame frame = observed(world_.render(upside_down));
  EXPECT_GT(locate(frame), 100);
  expect_at(frame, upside_down);
}

TEST_F(AppearanceTest, SurvivesManyWrongPoints) {
  MapEdit edit(known_.map);
  for (LandmarkId id = 0; id < known_.map.landmark_id_end(); id += 3)
    edit.landmark(id).position_in_world += Eigen::Vector3d(0.5 + 0.01 * (id % 50), -0.7, 0.6);
  known_.map = std::move(edit).finish();
  ObservedFrame frame = observed(world_.render(walk(2)));
  EXPECT_GT(locate(frame), 60);
  expect_at(frame, walk(2));
}

TEST_F(AppearanceTest, FlatWorldIsNoSpecialCase) {
  TestWorld wall(600, 4, {.low = {-2, -1.5, 3}, .high = {2, 1.5, 3}});
  known_ = known_map(wall, {wall.render(walk(0)), wall.render(walk(2))});
  for (const int step : {-4, 1, 5}) {
    ObservedFrame frame = observed(wall.render(walk(step)));
    EXPECT_GT(locate(frame), 100) << step;
    expect_at(frame, walk(step));
  }
}

TEST_F(AppearanceTest, MovingFeaturesAreNotUsed) {
  const View view = world_.render(walk(2));
  ObservedFrame frame = observed(view);
  for (std::uint32_t i = 0; i < view.point.size(); i += 2) frame.track_weights[i] = 0;
  EXPECT_GT(locate(frame), 50);
  for (std::uint32_t i = 0; i < view.point.size(); i += 2) EXPECT_EQ(frame.landmarks[i], kNoId);
}

TEST_F(AppearanceTest, UnknownPlaceGivesNothing) {
  TestWorld elsewhere(1500, 77);
  ObservedFrame frame = observed(elsewhere.render(walk(0)));
  EXPECT_EQ(locate(frame), 0);
}

TEST_F(AppearanceTest, NothingToLookForOrAtGivesNothing) {
  ObservedFrame frame = observed(world_.render(walk(0)));
  EXPECT_EQ(locate_by_appearance(frame, {}, known_.map), 0);
  TestWorld empty(0);
  ObservedFrame blind = observed(empty.render(walk(0)));
  EXPECT_EQ(locate(blind), 0);
}

TEST_F(AppearanceTest, RepeatsToTheBit) {
  const View view = world_.render(walk(4));
  ObservedFrame a = observed(view), b = observed(view);
  EXPECT_EQ(locate(a), locate(b));
  EXPECT_EQ(a.world_from_camera.matrix(), b.world_from_camera.matrix());
  EXPECT_EQ(a.landmarks, b.landmarks);
}

}  // namespace
}  // namespace stillpoint::orb_slam
