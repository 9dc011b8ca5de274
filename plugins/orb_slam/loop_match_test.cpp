#include "orb_slam/loop_match.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "orb_slam/orb_extractor.hpp"
#include "orb_slam/test_round_trip.hpp"
#include "orb_slam/test_scene.hpp"

namespace stillpoint::orb_slam {
namespace {

class LoopMatchTest : public testing::Test {
 protected:
  RoundTrip trip_;
  SparseMap map_ = trip_.map();
};

TEST_F(LoopMatchTest, FindsThePoseInTheOlderPart) {
  const auto loop = match_loop(map_, RoundTrip::kOneTurnOn, 0);
  ASSERT_TRUE(loop);
  EXPECT_GT(metres_between(map_.world_from_keyframe(RoundTrip::kOneTurnOn),
                           RoundTrip::truth(RoundTrip::kOneTurnOn)),
            0.1);
  EXPECT_LT(metres_between(loop->world_from_camera, RoundTrip::truth(RoundTrip::kOneTurnOn)), 0.02);
  EXPECT_LT(radians_between(loop->world_from_camera, RoundTrip::truth(RoundTrip::kOneTurnOn)),
            0.005);
  EXPECT_GT(loop->support, 0.5);
}

TEST_F(LoopMatchTest, PairsLandmarksOfOnePoint) {
  const auto loop = match_loop(map_, RoundTrip::kOneTurnOn, 0);
  ASSERT_TRUE(loop);
  EXPECT_GT(loop->same.size(), 200U);
  int wrong = 0;
  for (const auto& [older, newer] : loop->same) {
    EXPECT_LT(map_.landmark(older)->created_by, map_.landmark(newer)->created_by);
    wrong += trip_.point_of(map_, older) != trip_.point_of(map_, newer);
  }
  EXPECT_LE(wrong, static_cast<int>(loop->same.size() / 50));
}

TEST_F(LoopMatchTest, OtherPlacesAreNone) {
  for (const KeyFrameId place : {9U, 18U, 27U})
    EXPECT_FALSE(match_loop(map_, RoundTrip::kOneTurnOn, place));
}

// What moves is not mapped and takes no part.
TEST_F(LoopMatchTest, WithoutWeightNothingMatches) {
  MapEdit edit(map_);
  std::fill(edit.keyframe(RoundTrip::kOneTurnOn).map_weights.begin(),
            edit.keyframe(RoundTrip::kOneTurnOn).map_weights.end(), std::uint8_t{0});
  EXPECT_FALSE(match_loop(std::move(edit).finish(), RoundTrip::kOneTurnOn, 0));
}

TEST_F(LoopMatchTest, SameMapSameBits) {
  const auto a = match_loop(map_, RoundTrip::kOneTurnOn, 0),
             b = match_loop(map_, RoundTrip::kOneTurnOn, 0);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->world_from_camera.matrix(), b->world_from_camera.matrix());
  EXPECT_EQ(a->same, b->same);
}

/// With a landmark for each feature that has depth.
void add(MapEdit& edit, KeyFrame keyframe) {
  const KeyFrameId id = keyframe.id;
  const FeaturesPtr features = keyframe.features;
  const Pose world_from_camera = keyframe.world_from_camera;
  const auto camera = keyframe.camera;
  edit.add_keyframe(std::move(keyframe));
  for (std::uint32_t f = 0; f < features->size(); ++f) {
    const cv::Point2f p = features->keypoints[f].pt;
    const float depth = features->depth[f];
    if (depth <= 0) continue;
    const LandmarkId landmark = edit.add_landmark(
        {.position_in_world = world_from_camera * camera->unproject(p.x, p.y, depth),
         .reference = id,
         .created_by = id});
    edit.add_observation(landmark, {id, f});
    refresh_landmark(edit, landmark);
  }
}

KeyFrame keyframe_of(const FramePtr& frame, KeyFrameId id, const Pose& world_from_camera) {
  const ObservedFrame seen = observe(frame, OrbExtractor(OrbOptions{}).extract(frame->gray));
  return {.id = id,
          .frame = frame->index,
          .time = frame->time,
          .world_from_camera = world_from_camera,
          .camera = frame->camera,
          .features = seen.features,
          .track_weights = seen.track_weights,
          .map_weights = seen.map_weights,
          .landmarks = std::vector<LandmarkId>(seen.features->size(), kNoId)};
}

// What was on one level of the pyramid is two levels higher or lower.
TEST(LoopMatch, IsFoundFromAnotherDistance) {
  const TestScene scene;
  const Pose drift = pose_at({0.1, 0.05, -0.1});
  for (const double z : {-1.0, 1.0}) {
    MapEdit edit{SparseMap{}};
    add(edit, keyframe_of(scene.render(Pose::Identity(), 0), 0, Pose::Identity()));
    add(edit, keyframe_of(scene.render(pose_at({0, 0, z}), 300), 1, drift * pose_at({0, 0, z})));
    const auto loop = match_loop(std::move(edit).finish(), 1, 0);
    ASSERT_TRUE(loop) << z;
    EXPECT_LT(metres_between(loop->world_from_camera, pose_at({0, 0, z})), 0.02);
  }
}

// The same poster hangs in two places: its points fit, nothing around them does.
TEST(LoopMatch, OnePosterIsNoPlace) {
  TestWorld world(3000, 5, {{-4, -2, 2}, {4, 2, 6}});
  const View here = world.render(pose_at({0, 0, 0}));
  TestWorld other(3000, 6, {{-4, -2, 2}, {4, 2, 6}});
  View there = other.render(pose_at({0, 0, 0}));
  auto features = std::make_shared<Features>(*there.features);
  for (std::size_t i = 0; i < here.features->size(); ++i) {
    const cv::KeyPoint& k = here.features->keypoints[i];
    if (!cv::Rect(240, 160, 160, 160).contains(k.pt)) continue;
    features->keypoints.push_back(k);
    features->descriptors.push_back(here.features->descriptors[i]);
    features->depth.push_back(here.features->depth[i]);
    there.point.push_back(0);
  }
  there.features = features;
  there.world_from_camera = pose_at({20, 0, 0});

  MapEdit edit{SparseMap{}};
  add(edit, keyframe_of(here, 0));
  add(edit, keyframe_of(there, 1));
  EXPECT_FALSE(match_loop(std::move(edit).finish(), 1, 0));
}

}  // namespace
}  // namespace stillpoint::orb_slam
