#include "orb_slam/pose_graph.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_round_trip.hpp"

namespace stillpoint::orb_slam {
namespace {

class PoseGraphTest : public testing::Test {
 protected:
  static double worst_metres(const std::vector<MovedKeyFrame>& moved) {
    double worst = 0;
    for (const MovedKeyFrame& m : moved)
      worst = std::max(worst, metres_between(m.world_from_camera,
                                             RoundTrip::truth(static_cast<int>(m.keyframe))));
    return worst;
  }
  const SparseMap map_ = RoundTrip().map();
  const PoseEdge loop_{0, RoundTrip::kOneTurnOn,
                       RoundTrip::truth(0).inverse() * RoundTrip::truth(RoundTrip::kOneTurnOn)};
};

TEST_F(PoseGraphTest, SpreadsTheErrorOfALoop) {
  const auto moved = optimise_pose_graph(map_, {&loop_, 1}, {});
  ASSERT_EQ(moved.size(), map_.keyframe_count());
  EXPECT_EQ(moved.front().keyframe, 0U);
  EXPECT_EQ(moved.front().world_from_camera.matrix(), map_.world_from_keyframe(0).matrix());
  EXPECT_LT(metres_between(moved[RoundTrip::kOneTurnOn].world_from_camera,
                           RoundTrip::truth(RoundTrip::kOneTurnOn)),
            0.02);
  EXPECT_LT(worst_metres(moved), 0.75 * orb_slam::worst_metres(map_));
}

TEST_F(PoseGraphTest, WithoutLoopsEverythingStays) {
  for (const MovedKeyFrame& m : optimise_pose_graph(map_, {}, {}))
    EXPECT_LT(metres_between(m.world_from_camera, map_.world_from_keyframe(m.keyframe)), 1e-6);
}

// As culling does it: both sides of a closed loop see the same landmarks.
TEST_F(PoseGraphTest, ALoopOutlivesItsKeyFrames) {
  const PoseEdge loop{6, RoundTrip::kOneTurnOn,
                      RoundTrip::truth(6).inverse() * RoundTrip::truth(RoundTrip::kOneTurnOn)};
  const double with_them = worst_metres(optimise_pose_graph(map_, {&loop, 1}, {}));
  EXPECT_LT(with_them, 0.85 * orb_slam::worst_metres(map_));
  MapEdit edit(map_);
  for (const KeyFrameId id : {5U, 6U, RoundTrip::kOneTurnOn + 0U}) edit.remove_keyframe(id);
  const auto moved = optimise_pose_graph(std::move(edit).finish(), {&loop, 1}, {});
  EXPECT_EQ(moved.size(), map_.keyframe_count() - 3);
  EXPECT_NEAR(worst_metres(moved), with_them, 0.01);
}

TEST_F(PoseGraphTest, WhereTheCameraSlidTakesTheError) {
  // A corridor along x; at key frame 5 it slid half a metre too far.
  constexpr KeyFrameId kCount = 10, kSlid = 5;
  TestWorld nothing(0);
  MapEdit edit{SparseMap{}};
  for (KeyFrameId id = 0; id < kCount; ++id) {
    KeyFrame keyframe =
        keyframe_of(nothing.render(pose_at({id + (id >= kSlid ? 0.5 : 0.0), 0, 0})), id);
    if (id == kSlid) keyframe.covariance(0, 0) = 1.0;
    edit.add_keyframe(std::move(keyframe));
    edit.update_covisibility(id);
  }
  const PoseEdge loop{0, kCount - 1, pose_at({kCount - 1.0, 0, 0})};
  for (const MovedKeyFrame& m : optimise_pose_graph(std::move(edit).finish(), {&loop, 1}, {}))
    EXPECT_NEAR(m.world_from_camera.translation().x(), m.keyframe, 0.01) << m.keyframe;
}

TEST_F(PoseGraphTest, EndsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  const auto moved = optimise_pose_graph(map_, {&loop_, 1}, stop.get_token());
  EXPECT_LE(worst_metres(moved), orb_slam::worst_metres(map_) + 1e-9);
}

}  // namespace
}  // namespace stillpoint::orb_slam
