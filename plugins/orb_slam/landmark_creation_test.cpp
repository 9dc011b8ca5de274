#include "orb_slam/landmark_creation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

class CreateFromDepthTest : public testing::Test {
 protected:
  // Adds key frame 0 and makes its landmarks.
  std::vector<LandmarkId> create() {
    edit_.add_keyframe(keyframe_);
    auto created = create_from_depth(edit_, 0);
    EXPECT_EQ(edit_.map().check(), std::nullopt);
    return created;
  }
  std::uint32_t feature_of(LandmarkId id) const {
    return edit_.map().landmark(id)->observations.front().feature;
  }
  TestWorld world_;
  View view_ = world_.render(walk(2));
  KeyFrame keyframe_ = keyframe_of(view_, 0);
  MapEdit edit_{SparseMap{}};
};

TEST_F(CreateFromDepthTest, LandmarksLieWhereThePointsAre) {
  const auto created = create();
  EXPECT_EQ(created.size(), edit_.map().landmark_count());
  EXPECT_GT(created.size(), 200u);
  for (const LandmarkId id : created) {
    const Landmark& landmark = *edit_.map().landmark(id);
    const WorldPoint& truth = world_.points()[view_.point[feature_of(id)]];
    const double z = (walk(2).inverse() * truth.position).z();
    EXPECT_LT((landmark.position_in_world - truth.position).norm(), 0.02 + 0.01 * z * z);
    EXPECT_EQ(landmark.descriptor, view_.features->descriptors[feature_of(id)]);
    EXPECT_EQ(landmark.created_by, 0u);
    EXPECT_EQ(landmark.reference, 0u);
    EXPECT_GT(landmark.max_distance, 0);
  }
}

TEST_F(CreateFromDepthTest, EveryFeatureWithDepthAndNoOther) {
  view_ = world_.render(walk(2), {.max_depth = 4.0});
  keyframe_ = keyframe_of(view_, 0);
  const auto created = create();
  const auto& depth = view_.features->depth;
  EXPECT_EQ(static_cast<std::ptrdiff_t>(created.size()),
            std::count_if(depth.begin(), depth.end(), [](float d) { return d > 0; }));
  for (const LandmarkId id : created) EXPECT_GT(depth[feature_of(id)], 0);
}

TEST_F(CreateFromDepthTest, KnownLandmarksAreNotDoubled) {
  const KnownMap known = known_map(world_, {view_});
  edit_ = MapEdit(known.map);
  keyframe_.id = 1;
  keyframe_.landmarks = known.map.keyframe(0)->landmarks;
  for (std::size_t i = 60; i < keyframe_.landmarks.size(); ++i) keyframe_.landmarks[i] = kNoId;
  edit_.add_keyframe(keyframe_);
  const auto created = create_from_depth(edit_, 1);
  EXPECT_GT(created.size(), 20u);
  for (const LandmarkId id : created) EXPECT_GE(feature_of(id), 60u);
  EXPECT_EQ(edit_.map().check(), std::nullopt);
}

TEST_F(CreateFromDepthTest, WhatMayMoveBecomesNoLandmark) {
  for (std::uint32_t i = 0; i < view_.point.size(); ++i) {
    if (i % 3 == 0) keyframe_.map_weights[i] = 0;
    if (i % 3 == 1) keyframe_.track_weights[i] = 0;
  }
  const auto created = create();
  EXPECT_GT(created.size(), 50u);
  for (const LandmarkId id : created) EXPECT_EQ(feature_of(id) % 3, 2u);
}

TEST_F(CreateFromDepthTest, WithoutDepthNothingIsMade) {
  keyframe_ = keyframe_of(world_.render(walk(2), kNoDepth), 0);
  EXPECT_TRUE(create().empty());
}

// Two views without depth that already know half of what they see.
class TriangulateTest : public testing::Test {
 protected:
  std::vector<LandmarkId> run(const Pose& second) {
    first_ = world_.render(Pose::Identity(), kNoDepth);
    second_ = world_.render(second, kNoDepth);
    known_ = known_map(world_, {first_, second_});
    edit_ = MapEdit(known_.map);
    for (LandmarkId id = 0; id < known_.map.landmark_id_end(); id += 2) edit_.remove_landmark(id);
    edit_.update_covisibility(1);
    auto created = triangulate(edit_, 1, 10);
    EXPECT_EQ(edit_.map().check(), std::nullopt);
    return created;
  }
  TestWorld world_{1500, 1, {{-6, -4, 5}, {6, 4, 9}}};  // far away
  View first_, second_;
  KnownMap known_;
  MapEdit edit_{SparseMap{}};
};

TEST_F(TriangulateTest, FarPointsWithoutDepth) {
  const auto created = run(pose_at({0.6, 0.1, 0}, {0, -0.08, 0.02}));
  EXPECT_GT(created.size(), 100u);
  std::vector<double> errors;
  for (const LandmarkId id : created) {
    const Landmark& landmark = *edit_.map().landmark(id);
    ASSERT_EQ(landmark.observations.size(), 2u);
    EXPECT_EQ(landmark.created_by, 1u);
    const std::uint32_t a = first_.point[landmark.observations[0].feature];
    EXPECT_EQ(a, second_.point[landmark.observations[1].feature]) << "matched to another point";
    const Eigen::Vector3d& truth = world_.points()[a].position;
    errors.push_back((landmark.position_in_world - truth).norm() / truth.norm());
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.01) << "of the distance";
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.05);
}

TEST_F(TriangulateTest, TooLittleParallaxIsRefused) {
  EXPECT_TRUE(run(pose_at({0.04, 0, 0})).empty());
}

// The place of a feature of octave k is 1.2^k times as uncertain, and with it the distance.
TEST_F(TriangulateTest, CoarseFeaturesNeedMoreParallax) {
  const Pose second = pose_at({0.3, 0, 0});
  int fine = 0, coarse = 0;
  for (const LandmarkId id : run(second)) {
    const Observation& o = edit_.map().landmark(id)->observations.front();
    const int octave = first_.features->keypoints[o.feature].octave;
    const Eigen::Vector3d& truth = world_.points()[first_.point[o.feature]].position;
    const Eigen::Vector3d from_second = truth - second.translation();
    const double parallax = std::atan2(truth.cross(from_second).norm(), truth.dot(from_second));
    EXPECT_GT(parallax, 8 * std::pow(1.2, octave) / keyframe_of(first_, 0).camera->fx) << octave;
    (octave < 4 ? fine : coarse) += 1;
  }
  EXPECT_GT(fine, 50);
  EXPECT_LT(coarse, fine / 4);
}

TEST_F(TriangulateTest, TurningOnTheSpotGivesNothing) {
  EXPECT_TRUE(run(pose_at({0, 0, 0}, {0, 0.2, 0})).empty());
}

TEST_F(TriangulateTest, WhatMayMoveBecomesNoLandmark) {
  first_ = world_.render(Pose::Identity(), kNoDepth);
  second_ = world_.render(pose_at({0.6, 0, 0}), kNoDepth);
  known_ = known_map(world_, {first_, second_});
  edit_ = MapEdit(known_.map);
  for (LandmarkId id = 0; id < known_.map.landmark_id_end(); id += 2) edit_.remove_landmark(id);
  for (const KeyFrameId id : {0u, 1u}) {
    auto& weights = id == 0 ? edit_.keyframe(id).map_weights : edit_.keyframe(id).track_weights;
    weights.assign(weights.size(), 0);
  }
  EXPECT_TRUE(triangulate(edit_, 1, 10).empty());
}

TEST_F(TriangulateTest, AloneItDoesNothing) {
  edit_.add_keyframe(keyframe_of(world_.render(Pose::Identity()), 0));
  EXPECT_TRUE(triangulate(edit_, 0, 10).empty());
}

}  // namespace
}  // namespace stillpoint::orb_slam
