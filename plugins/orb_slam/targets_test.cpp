#include "orb_slam/targets.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

class TargetsTest : public testing::Test {
 protected:
  TestWorld world_;
  View view_ = world_.render(walk(0), kNoNoise);
  KnownMap known_ = known_map(world_, {view_});
};

TEST_F(TargetsTest, KeyFrameOffersItsLandmarks) {
  const auto targets = targets_of(*known_.map.keyframe(0), known_.map);
  ASSERT_EQ(targets.size(), view_.point.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    EXPECT_EQ(known_.point[targets[i].landmark], view_.point[i]);
    EXPECT_EQ(targets[i].point_in_world, world_.points()[view_.point[i]].position);
    EXPECT_EQ(targets[i].octave, view_.features->keypoints[i].octave);
  }
}

TEST_F(TargetsTest, FrameAddsTemporaryPointsFromFullyTrustedDepth) {
  ObservedFrame frame = observed(view_);
  frame.landmarks[0] = known_.landmark_of[view_.point[0]];
  frame.track_weights[1] = 254;
  const auto targets = targets_of(frame, known_.map);
  const auto with_depth = std::count_if(view_.features->depth.begin(), view_.features->depth.end(),
                                        [](float d) { return d > 0; });
  EXPECT_EQ(targets.size(), static_cast<std::size_t>(with_depth - 1));
  EXPECT_EQ(targets[0].landmark, frame.landmarks[0]);
  EXPECT_EQ(targets[1].landmark, kNoId);
  EXPECT_LT((targets[1].point_in_world - world_.points()[view_.point[2]].position).norm(), 1e-4);
}

TEST_F(TargetsTest, ProjectedTargetsFindTheirFeatures) {
  const View next = world_.render(walk(1));
  ObservedFrame frame = observed(next);
  frame.track_weights[3] = 0;
  const auto targets = targets_of(*known_.map.keyframe(0), known_.map);
  const int matches = match_projected(frame, targets, walk(1).inverse(), 10, 1);
  EXPECT_EQ(matches, frame.matched());
  EXPECT_GT(matches, 200);
  EXPECT_EQ(frame.landmarks[3], kNoId);
  for (std::uint32_t i = 0; i < next.point.size(); ++i)
    if (frame.landmarks[i] != kNoId) {
      EXPECT_EQ(known_.point[frame.landmarks[i]], next.point[i]);
    }
}

TEST_F(TargetsTest, TemporaryPointsAloneGiveThePose) {
  ObservedFrame last = observed(view_);
  ObservedFrame frame = observed(world_.render(walk(1)));
  const int matches =
      match_projected(frame, targets_of(last, SparseMap{}), walk(0).inverse(), 60, 1);
  EXPECT_EQ(frame.matched(), 0) << "temporary points are no landmarks";
  EXPECT_GT(solve_pose(frame, SparseMap{}), 0.8 * matches);
  EXPECT_LT(metres_between(frame.world_from_camera, walk(1)), 0.004);
  EXPECT_LT(radians_between(frame.world_from_camera, walk(1)), 0.0015);
}

TEST_F(TargetsTest, LookingAwayMatchesNothing) {
  ObservedFrame frame = observed(view_);
  const auto targets = targets_of(*known_.map.keyframe(0), known_.map);
  EXPECT_EQ(match_projected(frame, targets, pose_at({0, 0, 0}, {0, M_PI, 0}), 10, 1), 0);
}

}  // namespace
}  // namespace stillpoint::orb_slam
