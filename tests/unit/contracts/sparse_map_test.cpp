#include "stillpoint/contracts/sparse_map.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "stillpoint/contracts/map_correction.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

KeyFrame make_keyframe(KeyFrameId id, std::vector<LandmarkId> landmarks,
                       std::size_t features = 30) {
  auto points = std::make_shared<Features>();
  points->keypoints.resize(features);
  points->descriptors.resize(features);
  points->depth.resize(features);
  KeyFrame keyframe{.id = id, .features = points, .landmarks = std::move(landmarks)};
  keyframe.landmarks.resize(features, kNoId);
  keyframe.world_from_camera.translation().x() = id;
  return keyframe;
}

// Three key frames along x; the first sees landmarks 0…19, the second 0…19, the third 10…19.
SparseMap make_map() {
  MapEdit edit{SparseMap{}};
  edit.add_keyframe(make_keyframe(0, {}));
  std::vector<LandmarkId> ids;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const LandmarkId id = edit.add_landmark({.position_in_world = Eigen::Vector3d(0, 0, i)});
    edit.add_observation(id, {0, i});
    ids.push_back(id);
  }
  edit.update_covisibility(0);
  edit.add_keyframe(make_keyframe(1, ids));
  edit.update_covisibility(1);
  edit.add_keyframe(make_keyframe(2, {ids.begin() + 10, ids.end()}));
  edit.update_covisibility(2, 5);
  return std::move(edit).finish();
}

TEST(SparseMap, BuildsConsistentGraph) {
  const SparseMap map = make_map();
  EXPECT_EQ(map.check(), std::nullopt);
  EXPECT_EQ(map.keyframe_count(), 3u);
  EXPECT_EQ(map.landmark_count(), 20u);
  EXPECT_EQ(map.keyframe(1)->covisible.front().keyframe, 0u);
  EXPECT_EQ(map.keyframe(1)->covisible.front().shared, 20);
  EXPECT_EQ(map.keyframe(2)->covisible.size(), 2u);
  EXPECT_EQ(map.keyframe(2)->parent, 0u);
}

TEST(SparseMap, SnapshotsStayAsTheyWere) {
  const SparseMap before = make_map();
  MapEdit edit(before);
  edit.landmark(3).position_in_world.setConstant(7);
  edit.remove_landmark(4);
  edit.remove_keyframe(1);
  const SparseMap after = std::move(edit).finish();
  EXPECT_EQ(before.check(), std::nullopt);
  EXPECT_EQ(after.check(), std::nullopt);
  EXPECT_EQ(before.landmark(3)->position_in_world.z(), 3);
  EXPECT_EQ(after.landmark(3)->position_in_world.z(), 7);
  EXPECT_TRUE(before.landmark(4));
  EXPECT_FALSE(after.landmark(4));
  EXPECT_TRUE(before.keyframe(1));
}

TEST(SparseMap, RemovedKeyFrameFollowsItsParent) {
  MapEdit edit(make_map());
  edit.remove_keyframe(1);
  edit.keyframe(0).world_from_camera.translation().y() = 5;
  const SparseMap map = std::move(edit).finish();
  EXPECT_TRUE(map.world_from_keyframe(1).translation().isApprox(Eigen::Vector3d(1, 5, 0)));
}

TEST(SparseMap, AClearedMapBeginsAnewWithHigherIds) {
  MapEdit edit(make_map());
  edit.remove_keyframe(1);
  edit.fuse_landmarks(10, 11);
  edit.clear();
  EXPECT_TRUE(edit.map().empty());
  EXPECT_EQ(edit.map().landmark_count(), 0u);
  EXPECT_EQ(edit.map().keyframe_id_begin(), 3u);
  EXPECT_THROW(edit.keyframe(0), Error);

  edit.add_keyframe(make_keyframe(3, {0, 11}));
  EXPECT_EQ(edit.add_landmark({}), 20u);
  edit.add_observation(20, {3, 0});
  edit.update_covisibility(3);
  edit.add_keyframe(make_keyframe(4, {20}));
  edit.update_covisibility(4);
  const SparseMap map = std::move(edit).finish();
  EXPECT_EQ(map.check(), std::nullopt);
  EXPECT_EQ(map.keyframe(3)->parent, kNoId);
  EXPECT_EQ(map.keyframe(4)->parent, 3u);
  EXPECT_EQ(map.current_id(11), kNoId);
  for (const KeyFrameId id : {0u, 1u, 2u})
    EXPECT_EQ(map.world_from_keyframe(id).translation().x(), id) << "where it was";
  MapEdit second(map);
  EXPECT_THROW(second.remove_keyframe(3), Error) << "the oldest";
}

TEST(SparseMap, FusionKeepsEveryObservationOnce) {
  MapEdit edit(make_map());
  const LandmarkId duplicate = edit.add_landmark({});
  edit.add_observation(duplicate, {2, 25});
  edit.fuse_landmarks(0, duplicate);  // landmark 0 was not seen by key frame 2
  EXPECT_EQ(edit.map().landmark(0)->observations.size(), 3u);
  edit.fuse_landmarks(0, 15);  // both were seen by all three
  EXPECT_EQ(edit.map().landmark(0)->observations.size(), 3u);
  const SparseMap map = std::move(edit).finish();
  EXPECT_EQ(map.check(), std::nullopt);
  EXPECT_EQ(map.current_id(duplicate), 0u);
  EXPECT_EQ(map.current_id(15), 0u);
  EXPECT_EQ(map.current_id(kNoId), kNoId);
}

TEST(SparseMap, LastObservationTakesTheLandmarkAlong) {
  MapEdit edit(make_map());
  edit.remove_observation(0, 0);
  EXPECT_EQ(edit.map().landmark(0)->reference, 1u);
  edit.remove_observation(0, 1);
  EXPECT_FALSE(edit.map().landmark(0));
  EXPECT_EQ(edit.map().check(), std::nullopt);
}

// Errors, where plugins written carelessly would read out of bounds.
TEST(MapEdit, NamesWhatIsNotThere) {
  const auto message = [](const std::function<void(MapEdit&)>& change) -> std::string {
    MapEdit edit(make_map());
    try {
      change(edit);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(message([](MapEdit& e) { e.landmark(99).found = 2; }),
              HasSubstr("MapEdit: there is no landmark 99"));
  EXPECT_THAT(message([](MapEdit& e) { e.keyframe(kNoId).time = 2; }),
              HasSubstr("there is no key frame kNoId"));
  EXPECT_THAT(message([](MapEdit& e) {
                e.add_observation(3, {9, 0});
              }),
              HasSubstr("there is no key frame 9"));
  EXPECT_THAT(message([](MapEdit& e) {
                e.add_observation(3, {2, 30});
              }),
              HasSubstr("key frame 2 has no feature 30; features count from 0 to 30 - 1"));
  EXPECT_THAT(message([](MapEdit& e) { e.add_keyframe(make_keyframe(7, {})); }),
              HasSubstr("a key frame with id 7 is added; the next id is 3"));
  EXPECT_THAT(message([](MapEdit& e) { e.add_keyframe({.id = 3}); }),
              HasSubstr("without features"));
  EXPECT_THAT(message([](MapEdit& e) { e.fuse_landmarks(4, 4); }), HasSubstr("with itself"));
  EXPECT_THAT(message([](MapEdit& e) { e.remove_keyframe(0); }), HasSubstr("the oldest one stays"));
  EXPECT_THAT(message([](MapEdit& e) {
                e.remove_landmark(4);
                e.remove_landmark(4);
              }),
              HasSubstr("there is no landmark 4"));
  EXPECT_EQ(message([](MapEdit& e) { e.remove_keyframe(1); }), "");
}

TEST(MapCorrection, NewerKeyFramesAndTheirLandmarksFollow) {
  const SparseMap base = make_map();
  MapEdit growth(base);
  growth.add_keyframe(make_keyframe(3, {15, 16, 17, 18, 19}));
  growth.update_covisibility(3, 3);
  const LandmarkId fresh = growth.add_landmark({.position_in_world = {3, 0, 1}});
  growth.add_observation(fresh, {3, 20});
  const SparseMap grown = std::move(growth).finish();
  const Pose shift(Eigen::Translation3d(0, 2, 0));

  const MapCorrection correction{.keyframe_id_end = 3,
                                 .moved = {{grown.keyframe(3)->parent, shift}},
                                 .landmarks = {{19, {9, 9, 9}}},
                                 .fused = {{0, 1}}};
  const Pose old_parent = grown.world_from_keyframe(grown.keyframe(3)->parent);
  const SparseMap map = apply(correction, grown);

  EXPECT_EQ(map.check(), std::nullopt);
  const Pose moved = shift * old_parent.inverse();
  EXPECT_TRUE(map.world_from_keyframe(3).isApprox(moved * grown.world_from_keyframe(3)));
  EXPECT_TRUE(map.landmark(fresh)->position_in_world.isApprox(moved * Eigen::Vector3d(3, 0, 1)));
  EXPECT_TRUE(map.landmark(19)->position_in_world.isApprox(Eigen::Vector3d(9, 9, 9)));
  EXPECT_EQ(map.current_id(1), 0u);
}

}  // namespace
}  // namespace stillpoint
