#include "orb_slam/landmark_fusion.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

class LandmarkFusionTest : public testing::Test {
 protected:
  // Landmarks of key frame 1 that key frame 0 sees, too.
  std::vector<LandmarkId> shared() const {
    std::vector<LandmarkId> ids;
    for (const LandmarkId id : known_.map.keyframe(1)->landmarks)
      if (id != kNoId && known_.map.landmark(id)->observations.size() == 2) ids.push_back(id);
    return ids;
  }
  void fuse() {
    fuse_with_neighbours(edit_, 1, 10);
    EXPECT_EQ(edit_.map().check(), std::nullopt);
  }
  // Both observations of a landmark are of one point of the world.
  void expect_true_observations() const {
    for (LandmarkId id = 0; id < edit_.map().landmark_id_end(); ++id) {
      const Landmark* landmark = edit_.map().landmark(id);
      if (!landmark) continue;
      for (const Observation& o : landmark->observations)
        EXPECT_EQ(point_of(o), point_of(landmark->observations.front()));
    }
  }
  std::uint32_t point_of(const Observation& o) const { return views_[o.keyframe].point[o.feature]; }
  TestWorld world_;
  std::vector<View> views_{world_.render(walk(0)), world_.render(walk(2))};
  KnownMap known_ = known_map(world_, views_);
  MapEdit edit_{known_.map};
};

TEST_F(LandmarkFusionTest, DuplicatesBecomeOne) {
  // Every second shared landmark is split: key frame 1 made its own, 5 mm off.
  std::vector<std::pair<LandmarkId, LandmarkId>> split;
  const auto ids = shared();
  for (std::size_t i = 0; i < ids.size(); i += 2) {
    const Landmark old = *edit_.map().landmark(ids[i]);
    edit_.remove_observation(old.id, 1);
    refresh_landmark(edit_, old.id);
    const LandmarkId copy = edit_.add_landmark(
        {.position_in_world = old.position_in_world + Eigen::Vector3d(0.003, 0.004, 0),
         .created_by = 1});
    edit_.add_observation(copy, old.observations[1]);
    refresh_landmark(edit_, copy);
    split.emplace_back(old.id, copy);
  }
  ASSERT_GT(split.size(), 50u);
  fuse();
  std::size_t joined = 0;
  for (const auto& [a, b] : split) {
    if (edit_.map().current_id(a) != edit_.map().current_id(b)) continue;
    ++joined;
    EXPECT_EQ(edit_.map().landmark(edit_.map().current_id(a))->observations.size(), 2u);
  }
  EXPECT_GT(joined, split.size() * 9 / 10);
  expect_true_observations();
}

// A triangulation at the wrong depth lies on the ray of one key frame. What another one sees of the
// point must not become an observation of it, however many there are already.
TEST(LandmarkFusion, TheOneAtTheWrongPlaceGoes) {
  TestWorld world;
  const std::vector<View> views{world.render(walk(0)), world.render(walk(2)),
                                world.render(walk(4))};
  const KnownMap known = known_map(world, views);
  MapEdit edit(known.map);
  std::vector<std::pair<LandmarkId, LandmarkId>> split;
  for (LandmarkId id = 0; id < known.map.landmark_id_end(); ++id) {
    const Landmark* seen = known.map.landmark(id);
    if (!seen || seen->observations.size() != 3) continue;
    const Landmark old = *seen;
    edit.remove_observation(id, 2);
    const LandmarkId right = edit.add_landmark(
        {.position_in_world = old.position_in_world, .reference = 2, .created_by = 2});
    edit.add_observation(right, old.observations[2]);
    refresh_landmark(edit, right);
    const Eigen::Vector3d eye = views[0].world_from_camera.translation();
    edit.landmark(id).position_in_world = eye + 0.1 * (old.position_in_world - eye);
    refresh_landmark(edit, id);
    split.emplace_back(id, right);
  }
  ASSERT_GT(split.size(), 50u);
  fuse_with_neighbours(edit, 2, 10);
  EXPECT_EQ(edit.map().check(), std::nullopt);
  std::size_t joined = 0;
  for (const auto& [wrong, right] : split) {
    const Observation& seen = known.map.landmark(wrong)->observations[2];
    const LandmarkId now = edit.map().keyframe(2)->landmarks[seen.feature];
    ASSERT_NE(now, kNoId);
    EXPECT_EQ(now, right);
    joined += edit.map().landmark(now)->observations.size() == 3;
  }
  EXPECT_GT(joined, split.size() * 9 / 10);
}

TEST_F(LandmarkFusionTest, MissingObservationsAreAdded) {
  const auto ids = shared();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    edit_.remove_observation(ids[i], i % 2);  // one way and the other
    refresh_landmark(edit_, ids[i]);
  }
  fuse_with_neighbours(edit_, 1, 10);
  EXPECT_EQ(edit_.map().check(), std::nullopt);
  std::size_t complete = 0;
  for (const LandmarkId id : ids) {
    const Landmark* landmark = edit_.map().landmark(id);
    ASSERT_TRUE(landmark);
    complete += landmark->observations.size() == 2;
  }
  EXPECT_GT(complete, ids.size() * 9 / 10);
  expect_true_observations();
}

TEST_F(LandmarkFusionTest, WhatDoesNotFitTheGeometryStaysApart) {
  for (const LandmarkId id : shared()) {
    const Landmark old = *edit_.map().landmark(id);
    edit_.remove_observation(id, 1);
    refresh_landmark(edit_, id);
    const LandmarkId copy = edit_.add_landmark(
        {.position_in_world = old.position_in_world + Eigen::Vector3d(0.3, 0, 0)});
    edit_.add_observation(copy, old.observations[1]);
    refresh_landmark(edit_, copy);
    if (id % 2 == 0) edit_.landmark(id).position_in_world += Eigen::Vector3d(0, 0.4, 0);
  }
  fuse();
  expect_true_observations();
}

TEST_F(LandmarkFusionTest, MovingFeaturesGetNoObservation) {
  const auto ids = shared();
  for (const LandmarkId id : ids) {
    edit_.remove_observation(id, 0);
    refresh_landmark(edit_, id);
  }
  auto& weights = edit_.keyframe(0).track_weights;
  weights.assign(weights.size(), 0);
  fuse();
  for (const LandmarkId id : ids) EXPECT_EQ(edit_.map().landmark(id)->observations.size(), 1u);
}

TEST_F(LandmarkFusionTest, CompleteMapStaysAsItIs) {
  fuse();
  EXPECT_EQ(edit_.map().landmark_count(), known_.map.landmark_count());
}

TEST_F(LandmarkFusionTest, AloneItDoesNothing) {
  MapEdit alone{SparseMap{}};
  alone.add_keyframe(keyframe_of(views_[0], 0));
  fuse_with_neighbours(alone, 0, 10);
  EXPECT_EQ(alone.map().landmark_count(), 0u);
}

}  // namespace
}  // namespace stillpoint::orb_slam
