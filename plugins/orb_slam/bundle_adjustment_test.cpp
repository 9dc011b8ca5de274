#include "orb_slam/bundle_adjustment.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr BundleOptions kAll{.max_keyframes = 20, .max_iterations = 20};

class BundleAdjustmentTest : public testing::Test {
 protected:
  static constexpr int kViews = 8;

  BundleAdjustmentTest() {
    for (int i = 0; i < kViews; ++i) views_.push_back(world_.render(walk(2 * i)));
    known_ = known_map(world_, views_);
    start_ = known_.map;
  }
  // Poses but the first by centimetres, points by as much.
  void disturb() {
    MapEdit edit(start_);
    for (KeyFrameId id = 1; id < kViews; ++id) {
      const Vector6d twist = Vector6d::NullaryExpr([&] { return 0.01 * world_.normal(); });
      Pose& pose = edit.keyframe(id).world_from_camera;
      pose = pose * exp_se3(twist);
    }
    for (LandmarkId id = 0; id < start_.landmark_id_end(); ++id)
      edit.landmark(id).position_in_world +=
          Eigen::Vector3d::NullaryExpr([&] { return 0.03 * world_.normal(); });
    start_ = std::move(edit).finish();
  }
  SparseMap adjust(KeyFrameId centre, const BundleOptions& options,
                   std::stop_token end_early = {}) const {
    MapEdit edit(start_);
    adjust_locally(edit, centre, options, end_early);
    EXPECT_EQ(edit.map().check(), std::nullopt);
    return std::move(edit).finish();
  }
  double worst_pose(const SparseMap& map) const {
    double worst = 0;
    for (KeyFrameId id = 0; id < kViews; ++id)
      worst = std::max(worst,
                       metres_between(map.world_from_keyframe(id), views_[id].world_from_camera));
    return worst;
  }
  double median_point_error(const SparseMap& map) const {
    std::vector<double> errors;
    for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
      if (const Landmark* landmark = map.landmark(id))
        errors.push_back(
            (landmark->position_in_world - world_.points()[known_.point[id]].position).norm());
    std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
    return errors[errors.size() / 2];
  }
  static void expect_same_bits(const SparseMap& a, const SparseMap& b) {
    ASSERT_EQ(a.landmark_count(), b.landmark_count());
    for (KeyFrameId id = 0; id < a.keyframe_id_end(); ++id)
      EXPECT_EQ(a.keyframe(id)->world_from_camera.matrix(),
                b.keyframe(id)->world_from_camera.matrix());
    for (LandmarkId id = 0; id < a.landmark_id_end(); ++id)
      if (a.landmark(id)) {
        EXPECT_EQ(a.landmark(id)->position_in_world, b.landmark(id)->position_in_world);
      }
  }
  static std::size_t observations(const SparseMap& map) {
    std::size_t count = 0;
    for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
      if (map.landmark(id)) count += map.landmark(id)->observations.size();
    return count;
  }
  TestWorld world_{800};
  std::vector<View> views_;
  KnownMap known_;
  SparseMap start_;
};

TEST_F(BundleAdjustmentTest, PosesAndPointsGoToTheTruth) {
  disturb();
  const double pose_before = worst_pose(start_), points_before = median_point_error(start_);
  const SparseMap map = adjust(kViews - 1, kAll);
  EXPECT_LT(worst_pose(map), 0.2 * pose_before);
  EXPECT_LT(worst_pose(map), 0.004);
  EXPECT_LT(median_point_error(map), 0.5 * points_before);
}

TEST_F(BundleAdjustmentTest, ExactMeasurementsGiveTheExactMap) {
  views_.clear();
  for (int i = 0; i < kViews; ++i) views_.push_back(world_.render(walk(2 * i), kNoNoise));
  known_ = known_map(world_, views_);
  start_ = known_.map;
  disturb();
  const SparseMap map = adjust(kViews - 1, {.max_keyframes = 20, .max_iterations = 50});
  EXPECT_LT(worst_pose(map), 1e-4);
  EXPECT_LT(median_point_error(map), 1e-4);
}

TEST_F(BundleAdjustmentTest, FirstKeyFrameStaysToTheBit) {
  disturb();
  const SparseMap map = adjust(0, kAll);
  EXPECT_EQ(map.keyframe(0)->world_from_camera.matrix(),
            start_.keyframe(0)->world_from_camera.matrix());
  EXPECT_EQ(map.keyframe(0)->world_from_camera.matrix(), Pose::Identity().matrix());
}

TEST_F(BundleAdjustmentTest, OnlyTheNeighbourhoodMoves) {
  disturb();
  const SparseMap map = adjust(kViews - 1, {.max_keyframes = 3, .max_iterations = 10});
  int moved = 0;
  for (KeyFrameId id = 0; id < kViews; ++id) {
    const bool same = map.keyframe(id)->world_from_camera.matrix() ==
                      start_.keyframe(id)->world_from_camera.matrix();
    moved += !same;
    if (id < 3) {
      EXPECT_TRUE(same) << "key frame " << id;
    }
  }
  EXPECT_EQ(moved, 3);
}

TEST_F(BundleAdjustmentTest, ReturnsWhatItAdjusted) {
  disturb();
  MapEdit edit(start_);
  const auto adjusted = adjust_locally(edit, 1, {.max_keyframes = 2, .max_iterations = 5}, {});
  std::vector<bool> returned(start_.landmark_id_end());
  for (const LandmarkId id : adjusted) returned[id] = true;
  for (LandmarkId id = 0; id < start_.landmark_id_end(); ++id)
    if (!returned[id]) {
      EXPECT_EQ(start_.landmark(id)->position_in_world, edit.map().landmark(id)->position_in_world);
    }
  EXPECT_GT(adjusted.size(), 100u);
}

TEST_F(BundleAdjustmentTest, WrongObservationsAreDropped) {
  std::vector<Observation> wrong;
  MapEdit edit(start_);
  for (const KeyFrameId id : {2u, 4u}) {
    auto features = std::make_shared<Features>(*start_.keyframe(id)->features);
    for (std::uint32_t i = 0; i < 20; ++i) {
      features->keypoints[i].pt.x += 40;
      wrong.push_back({id, i});
    }
    edit.keyframe(id).features = std::move(features);
  }
  start_ = std::move(edit).finish();
  const std::size_t before = observations(start_);
  const SparseMap map = adjust(kViews - 1, kAll);
  std::size_t left = 0;
  for (const Observation& o : wrong) {
    const LandmarkId id = map.keyframe(o.keyframe)->landmarks[o.feature];
    left += id != kNoId && map.landmark(id)->observations.size() > 1;
  }
  EXPECT_LE(left, 2u);
  EXPECT_GT(observations(map), 0.95 * (before - wrong.size())) << "right ones stay";
  EXPECT_LT(worst_pose(map), 0.01);
}

TEST_F(BundleAdjustmentTest, SoftWeightsDoNotPull) {
  // A third of the features of every view follow something that moves 3 cm per key frame.
  MapEdit edit(start_);
  for (KeyFrameId id = 1; id < kViews; ++id) {
    auto features = std::make_shared<Features>(*start_.keyframe(id)->features);
    KeyFrame& keyframe = edit.keyframe(id);
    for (std::uint32_t i = 0; i < features->size(); ++i) {
      if (views_[id].point[i] % 3 != 0) continue;
      features->keypoints[i].pt.x += 5.0f * static_cast<float>(id);
      keyframe.track_weights[i] = 0;
    }
    keyframe.features = std::move(features);
  }
  start_ = std::move(edit).finish();
  EXPECT_LT(worst_pose(adjust(kViews - 1, kAll)), 0.004);
}

TEST_F(BundleAdjustmentTest, EarlyEndWithAConsistentMap) {
  disturb();
  std::stop_source end_early;
  end_early.request_stop();
  const SparseMap map = adjust(kViews - 1, kAll, end_early.get_token());
  EXPECT_EQ(map.keyframe_count(), start_.keyframe_count());
  EXPECT_GT(map.landmark_count(), 0u);
  for (KeyFrameId id = 0; id < kViews; ++id)
    EXPECT_TRUE(map.keyframe(id)->world_from_camera.matrix().allFinite());
  const double done = worst_pose(adjust(kViews - 1, kAll));
  EXPECT_GT(worst_pose(map), 2 * done) << "it was not early";
}

TEST_F(BundleAdjustmentTest, SameInputSameBits) {
  disturb();
  expect_same_bits(adjust(kViews - 1, kAll), adjust(kViews - 1, kAll));
}

TEST_F(BundleAdjustmentTest, KeyFrameWithoutLandmarksIsNoCrash) {
  MapEdit edit(start_);
  edit.add_keyframe(keyframe_of(world_.render(walk(1)), kViews));
  edit.update_covisibility(kViews);
  EXPECT_TRUE(adjust_locally(edit, kViews, kAll, {}).empty());
  EXPECT_EQ(edit.map().check(), std::nullopt);
}

}  // namespace
}  // namespace stillpoint::orb_slam
