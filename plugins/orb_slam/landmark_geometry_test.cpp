#include "orb_slam/landmark_geometry.hpp"

#include <gtest/gtest.h>

#include "orb_slam/pose_solver.hpp"
#include "orb_slam/scale_pyramid.hpp"
#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

class LandmarkGeometryTest : public testing::Test {
 protected:
  LandmarkGeometryTest() {
    std::vector<View> views;
    for (int i = 0; i < 6; ++i) views.push_back(world_.render(walk(i)));
    known_ = known_map(world_, views);
  }
  LandmarkId observed_by_all() const {
    for (LandmarkId id = 0; id < known_.map.landmark_id_end(); ++id)
      if (known_.map.landmark(id)->observations.size() == 6) return id;
    return kNoId;
  }
  TestWorld world_;
  KnownMap known_;
};

TEST_F(LandmarkGeometryTest, FieldsFollowFromTheObservations) {
  const LandmarkId id = observed_by_all();
  const Landmark& landmark = *known_.map.landmark(id);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < 6; ++i)
    mean += (landmark.position_in_world - walk(i).translation()).normalized();
  EXPECT_LT((landmark.mean_view - mean.normalized()).norm(), 1e-9);

  const WorldPoint& truth = world_.points()[known_.point[id]];
  EXPECT_LE(hamming_distance(landmark.descriptor, truth.descriptor), 10);
  EXPECT_NEAR(landmark.max_distance, truth.max_distance, 0.11 * truth.max_distance)
      << "to half a level";
  EXPECT_LT(landmark.min_distance, landmark.max_distance);
}

TEST_F(LandmarkGeometryTest, DescriptorIsTheMostTypicalOne) {
  const LandmarkId id = observed_by_all();
  MapEdit edit(known_.map);
  for (const KeyFrameId odd : {0u, 3u}) {  // the first one counts no more than others
    auto features = std::make_shared<Features>(*edit.map().keyframe(odd)->features);
    features->descriptors[known_.map.landmark(id)->observations[odd].feature] = world_.descriptor();
    edit.keyframe(odd).features = std::move(features);
  }
  refresh_landmark(edit, id);
  EXPECT_LE(hamming_distance(edit.map().landmark(id)->descriptor,
                             world_.points()[known_.point[id]].descriptor),
            10);
}

TEST_F(LandmarkGeometryTest, GoneLandmarkIsPassedOver) {
  MapEdit edit(known_.map);
  edit.remove_landmark(4);
  refresh_landmark(edit, 4);
  EXPECT_EQ(edit.map().landmark(4), nullptr);
}

TEST_F(LandmarkGeometryTest, TrueObservationsFit) {
  int fit = 0, all = 0;
  for (LandmarkId id = 0; id < known_.map.landmark_id_end(); ++id) {
    const Landmark& landmark = *known_.map.landmark(id);
    for (const Observation& o : landmark.observations) {
      const KeyFrame& keyframe = *known_.map.keyframe(o.keyframe);
      fit += observation_error(landmark.position_in_world, keyframe.world_from_camera.inverse(),
                               keyframe, o.feature)
                 .fits();
      ++all;
    }
  }
  EXPECT_GT(fit, 0.95 * all);
}

TEST_F(LandmarkGeometryTest, ErrorInStandardDeviations) {
  const View view = world_.render(Pose::Identity(), kNoNoise);
  KeyFrame keyframe = keyframe_of(view, 0);
  auto features = std::make_shared<Features>(*view.features);
  const Eigen::Vector3d point = world_.points()[view.point[0]].position;
  const double sigma = std::pow(1.2, features->keypoints[0].octave);
  features->keypoints[0].pt.x += static_cast<float>(2.0 * sigma);
  keyframe.features = features;
  ObservationError error = observation_error(point, Pose::Identity(), keyframe, 0);
  EXPECT_NEAR(error.squared, 4.0, 0.01);
  EXPECT_EQ(error.bound, kChiSquare3);
  features->keypoints[0].pt.x += static_cast<float>(sigma);
  EXPECT_FALSE(observation_error(point, Pose::Identity(), keyframe, 0).fits());

  features->depth[0] = 0;
  error = observation_error(point, Pose::Identity(), keyframe, 0);
  EXPECT_NEAR(error.squared, 9.0, 0.02);
  EXPECT_EQ(error.bound, kChiSquare2);
}

TEST_F(LandmarkGeometryTest, WrongDepthAloneDoesNotFit) {
  const View view = world_.render(Pose::Identity(), kNoNoise);
  KeyFrame keyframe = keyframe_of(view, 0);
  auto features = std::make_shared<Features>(*view.features);
  const Eigen::Vector3d point = world_.points()[view.point[0]].position;
  features->depth[0] = static_cast<float>(1.0 / (1.0 / point.z() + 3 * view.camera->depth_noise));
  keyframe.features = features;
  EXPECT_NEAR(observation_error(point, Pose::Identity(), keyframe, 0).squared, 9.0, 0.02);
  EXPECT_FALSE(observation_error(point, Pose::Identity(), keyframe, 0).fits());
}

TEST_F(LandmarkGeometryTest, BehindTheCameraNothingFits) {
  const KeyFrame& keyframe = *known_.map.keyframe(0);
  const ObservationError error = observation_error({0, 0, -2}, Pose::Identity(), keyframe, 0);
  EXPECT_TRUE(std::isinf(error.squared));
  EXPECT_FALSE(error.fits());
}

}  // namespace
}  // namespace stillpoint::orb_slam
