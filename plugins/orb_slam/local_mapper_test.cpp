#include "orb_slam/local_mapper.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kSteps = 15;

// A camera walks through the world; tracking finds most landmarks and the pose to some millimetres.
class LocalMapperTest : public testing::Test {
 protected:
  KeyFrame next_keyframe(const Noise& noise = {}) {
    const auto id = static_cast<KeyFrameId>(views_.size());
    views_.push_back(world_.render(walk(3 * static_cast<int>(id)), noise));
    KeyFrame keyframe = keyframe_of(views_.back(), id);
    if (id == 0) return keyframe;
    const Vector6d twist = Vector6d::NullaryExpr([&] { return 0.003 * world_.normal(); });
    keyframe.world_from_camera = keyframe.world_from_camera * exp_se3(twist);
    const std::vector<LandmarkId> landmark_of = landmarks_by_point();
    for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i)
      if (world_.uniform(0, 1) < 0.8) keyframe.landmarks[i] = landmark_of[views_.back().point[i]];
    return keyframe;
  }
  std::vector<LandmarkId> landmarks_by_point() const {
    std::vector<LandmarkId> ids(world_.points().size(), kNoId);
    for (LandmarkId id = 0; id < map_.landmark_id_end(); ++id)
      if (map_.landmark(id)) ids[point_of(id)] = id;
    return ids;
  }
  std::uint32_t point_of(LandmarkId id) const {
    const Observation& o = map_.landmark(id)->observations.front();
    return views_[o.keyframe].point[o.feature];
  }
  void step(const Noise& noise = {}, std::stop_token end_early = {}) {
    KeyFrame keyframe = next_keyframe(noise);
    const KeyFrameId id = keyframe.id;
    map_ = mapper_.insert(std::move(map_), std::move(keyframe));
    ASSERT_EQ(map_.check(), std::nullopt) << "insert " << id;
    map_ = mapper_.refine(std::move(map_), id, end_early);
    ASSERT_EQ(map_.check(), std::nullopt) << "refine " << id;
  }
  double worst_pose() const {
    double worst = 0;
    for (KeyFrameId id = 0; id < views_.size(); ++id)
      worst = std::max(worst,
                       metres_between(map_.world_from_keyframe(id), views_[id].world_from_camera));
    return worst;
  }
  // Of landmarks with several observations, in ascending order.
  std::vector<double> landmark_errors() const {
    std::vector<double> errors;
    for (LandmarkId id = 0; id < map_.landmark_id_end(); ++id)
      if (const Landmark* landmark = map_.landmark(id);
          landmark && landmark->observations.size() >= 2)
        errors.push_back(
            (landmark->position_in_world - world_.points()[point_of(id)].position).norm());
    std::sort(errors.begin(), errors.end());
    return errors;
  }
  TestWorld world_;
  std::vector<View> views_;
  SparseMap map_;
  OrbLocalMapper mapper_{OrbLocalMapper::Options{}, StageContext{}};
};

TEST_F(LocalMapperTest, MapOfAWalkIsTrue) {
  for (int i = 0; i < kSteps; ++i) step();
  EXPECT_LT(worst_pose(), 0.01);
  const auto errors = landmark_errors();
  ASSERT_GT(errors.size(), 300u);
  EXPECT_LT(errors[errors.size() / 2], 0.02);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.1);
}

TEST_F(LocalMapperTest, FarPointsWithoutDepthComeFromTwoViews) {
  const Noise near_depth_only{.max_depth = 4.0};
  for (int i = 0; i < 8; ++i) step(near_depth_only);
  int far = 0;
  for (LandmarkId id = 0; id < map_.landmark_id_end(); ++id)
    far += map_.landmark(id) && world_.points()[point_of(id)].position.z() > 6.0;
  EXPECT_GT(far, 30);
  EXPECT_LT(worst_pose(), 0.012);
}

TEST_F(LocalMapperTest, InsertGivesLandmarksAtOnce) {
  map_ = mapper_.insert(SparseMap{}, next_keyframe());
  EXPECT_GE(map_.landmark_count(), 100u);
  EXPECT_EQ(map_.keyframe(0)->world_from_camera.matrix(), Pose::Identity().matrix());
}

TEST_F(LocalMapperTest, LandmarksThatProveToMoveAreRemoved) {
  step();
  const auto first =
      std::ranges::find_if(map_.keyframe(0)->landmarks, [](LandmarkId id) { return id != kNoId; });
  ASSERT_NE(first, map_.keyframe(0)->landmarks.end());
  const LandmarkId moving = *first;
  for (const float log_odds : {-2.0f, -0.5f, -1.0f}) {
    ASSERT_TRUE(map_.landmark(moving)) << "-2.5 is not enough";
    KeyFrame keyframe = next_keyframe();
    keyframe.evidence = {{.landmark = moving, .visible = 4, .static_log_odds = log_odds}};
    map_ = mapper_.insert(std::move(map_), std::move(keyframe));
  }
  EXPECT_FALSE(map_.landmark(moving));
}

TEST_F(LocalMapperTest, EvidenceIsAddedToLandmarksOnce) {
  step();
  const LandmarkId seen = landmarks_by_point()[views_[0].point[0]] == kNoId
                              ? map_.keyframe(0)->landmarks[1]
                              : map_.keyframe(0)->landmarks[0];
  ASSERT_NE(seen, kNoId);
  KeyFrame keyframe = next_keyframe();
  keyframe.evidence = {{.landmark = seen, .visible = 7, .found = 5, .static_log_odds = -1.5f},
                       {.landmark = 1000000, .visible = 7, .found = 5}};
  map_ = mapper_.insert(std::move(map_), std::move(keyframe));
  EXPECT_EQ(map_.landmark(seen)->visible, 8u);
  EXPECT_EQ(map_.landmark(seen)->found, 6u);
  EXPECT_EQ(map_.landmark(seen)->static_log_odds, -1.5f);
  EXPECT_TRUE(map_.keyframe(1)->evidence.empty());
}

TEST_F(LocalMapperTest, EarlyEndLeavesAConsistentMap) {
  std::stop_source end_early;
  end_early.request_stop();
  for (int i = 0; i < kSteps; ++i) step({}, end_early.get_token());
  EXPECT_EQ(map_.keyframe_count(), static_cast<std::size_t>(kSteps));
  EXPECT_LT(worst_pose(), 0.03);
}

TEST_F(LocalMapperTest, WrongMatchesOfTrackingAreThrownOut) {
  for (int i = 0; i < 5; ++i) step();
  KeyFrame keyframe = next_keyframe();
  int wrong = 0;
  for (std::uint32_t i = 0; i + 1 < keyframe.landmarks.size() && wrong < 30; i += 2, ++wrong)
    std::swap(keyframe.landmarks[i], keyframe.landmarks[i + 1]);
  const KeyFrameId id = keyframe.id;
  map_ = mapper_.refine(mapper_.insert(std::move(map_), std::move(keyframe)), id, {});
  ASSERT_EQ(map_.check(), std::nullopt);
  int left = 0;
  for (std::uint32_t i = 0; i < 60; ++i)
    if (const LandmarkId landmark = map_.keyframe(id)->landmarks[i]; landmark != kNoId)
      left += point_of(landmark) != views_[id].point[i];
  EXPECT_LE(left, 2);
}

TEST_F(LocalMapperTest, KeyFrameThatSharesNothingIsInsertedAllTheSame) {
  step();
  TestWorld elsewhere(1500, 55);
  views_.push_back(elsewhere.render(walk(0)));
  map_ = mapper_.insert(std::move(map_), keyframe_of(views_.back(), 1));
  EXPECT_EQ(map_.check(), std::nullopt);
  map_ = mapper_.refine(std::move(map_), 1, {});
  EXPECT_EQ(map_.check(), std::nullopt);
  EXPECT_EQ(map_.keyframe(1)->parent, 0u);
}

TEST_F(LocalMapperTest, KeyFrameWithoutFeaturesIsNoCrash) {
  step();
  TestWorld empty(0);
  views_.push_back(empty.render(walk(0)));
  map_ = mapper_.refine(mapper_.insert(std::move(map_), keyframe_of(views_.back(), 1)), 1, {});
  EXPECT_EQ(map_.check(), std::nullopt);
}

TEST_F(LocalMapperTest, SameInputSameMap) {
  for (int i = 0; i < 6; ++i) step();
  const SparseMap first = map_;
  map_ = {};
  views_.clear();
  world_ = TestWorld();
  mapper_ = OrbLocalMapper(OrbLocalMapper::Options{}, StageContext{});
  for (int i = 0; i < 6; ++i) step();
  ASSERT_EQ(first.landmark_id_end(), map_.landmark_id_end());
  for (LandmarkId id = 0; id < first.landmark_id_end(); ++id) {
    ASSERT_EQ(first.landmark(id) == nullptr, map_.landmark(id) == nullptr);
    if (first.landmark(id)) {
      EXPECT_EQ(first.landmark(id)->position_in_world, map_.landmark(id)->position_in_world);
    }
  }
}

}  // namespace
}  // namespace stillpoint::orb_slam
