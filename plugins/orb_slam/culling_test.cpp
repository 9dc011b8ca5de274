#include "orb_slam/culling.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

// One feature per key frame and landmark: landmark i is feature i, wherever it is seen.
class CullLandmarksTest : public testing::Test {
 protected:
  CullLandmarksTest() {
    const View view = world_.render(Pose::Identity());
    for (KeyFrameId id = 0; id < 10; ++id) edit_.add_keyframe(keyframe_of(view, id));
  }
  LandmarkId add(KeyFrameId created_by, int observations, std::uint32_t visible = 10,
                 std::uint32_t found = 9) {
    const LandmarkId id =
        edit_.add_landmark({.created_by = created_by, .visible = visible, .found = found});
    for (int i = 0; i < observations; ++i)
      edit_.add_observation(id, {created_by + static_cast<KeyFrameId>(i), id});
    recent_.push_back(id);
    return id;
  }
  void cull(KeyFrameId latest) {
    cull_landmarks(edit_, latest, recent_);
    EXPECT_EQ(edit_.map().check(), std::nullopt);
  }
  bool exists(LandmarkId id) const { return edit_.map().landmark(id) != nullptr; }
  bool on_probation(LandmarkId id) const {
    return std::find(recent_.begin(), recent_.end(), id) != recent_.end();
  }
  TestWorld world_;
  MapEdit edit_{SparseMap{}};
  std::vector<LandmarkId> recent_;
};

TEST_F(CullLandmarksTest, SeldomFoundOnesGo) {
  const LandmarkId seldom = add(5, 1, 100, 10), often = add(5, 1, 100, 90);
  cull(5);
  EXPECT_FALSE(exists(seldom));
  EXPECT_FALSE(on_probation(seldom));
  EXPECT_TRUE(exists(often));
  EXPECT_TRUE(on_probation(often));
}

TEST_F(CullLandmarksTest, OnesThatNobodyElseSeesGoInTime) {
  const LandmarkId lonely = add(3, 1), seen_twice = add(3, 2);
  cull(3);
  EXPECT_TRUE(exists(lonely));
  cull(4);
  EXPECT_TRUE(exists(lonely));
  for (KeyFrameId latest = 5; latest < 8; ++latest) cull(latest);
  EXPECT_FALSE(exists(lonely));
  EXPECT_TRUE(exists(seen_twice));
}

TEST_F(CullLandmarksTest, ProbationEndsForGoodOnes) {
  const LandmarkId good = add(1, 3);
  cull(9);
  EXPECT_TRUE(exists(good));
  EXPECT_THAT(recent_, testing::IsEmpty());
}

TEST_F(CullLandmarksTest, OnesThatAreGoneLeaveTheList) {
  const LandmarkId gone = add(1, 2);
  edit_.remove_landmark(gone);
  cull(1);
  EXPECT_THAT(recent_, testing::IsEmpty());
}

TEST_F(CullLandmarksTest, OthersAreNotTouched) {
  const LandmarkId bad = add(1, 1, 100, 1);
  recent_.clear();
  cull(9);
  EXPECT_TRUE(exists(bad)) << "only those on probation are judged";
}

class CullKeyFramesTest : public testing::Test {
 protected:
  SparseMap culled(const std::vector<View>& views, double share) {
    MapEdit edit(known_map(world_, views).map);
    cull_keyframes(edit, static_cast<KeyFrameId>(views.size() - 1), share);
    EXPECT_EQ(edit.map().check(), std::nullopt);
    return std::move(edit).finish();
  }
  TestWorld world_;
};

TEST_F(CullKeyFramesTest, RedundantOnesGoOriginAndLatestStay) {
  std::vector<View> views;
  for (int i = 0; i < 8; ++i) views.push_back(world_.render(pose_at({0.002 * i, 0, 0})));
  const SparseMap map = culled(views, 0.9);
  EXPECT_LT(map.keyframe_count(), 6u);
  EXPECT_GE(map.keyframe_count(), 3u) << "somebody must see the landmarks";
  EXPECT_TRUE(map.keyframe(0));
  EXPECT_TRUE(map.keyframe(7));
  for (KeyFrameId id = 0; id < 8; ++id)  // also removed ones have a place
    EXPECT_LT(metres_between(map.world_from_keyframe(id), pose_at({0.002 * id, 0, 0})), 1e-9);
}

TEST_F(CullKeyFramesTest, DifferentViewsStay) {
  std::vector<View> views;
  for (int i = 0; i < 5; ++i) views.push_back(world_.render(pose_at({2.0 * i - 4, 0, 0})));
  EXPECT_EQ(culled(views, 0.9).keyframe_count(), 5u);
}

TEST_F(CullKeyFramesTest, AFinerLookIsNotReplacedByCoarserOnes) {
  // Coarser = on higher levels, as from nearer; the first view has all features on level 0.
  std::vector<View> views;
  for (int i = 0; i < 6; ++i) {
    views.push_back(world_.render(pose_at({0.002 * i, 0, 0})));
    auto features = std::make_shared<Features>(*views[i].features);
    for (cv::KeyPoint& k : features->keypoints) k.octave = i == 1 ? 0 : 4;
    views[i].features = std::move(features);
  }
  EXPECT_TRUE(culled(views, 0.9).keyframe(1));
}

TEST_F(CullKeyFramesTest, ShareOfOneKeepsAll) {
  std::vector<View> views(8, world_.render(Pose::Identity()));
  EXPECT_EQ(culled(views, 1.0).keyframe_count(), 8u);
}

}  // namespace
}  // namespace stillpoint::orb_slam
