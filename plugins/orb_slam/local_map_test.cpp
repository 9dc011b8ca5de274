#include "orb_slam/local_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

class LocalMapTest : public testing::Test {
 protected:
  LocalMapTest() {
    std::vector<View> views;
    for (int i = 0; i < 12; ++i) views.push_back(world_.render(walk(3 * i)));
    known_ = known_map(world_, views);
  }
  std::vector<LandmarkId> observed_by(KeyFrameId id) const {
    return known_.map.keyframe(id)->landmarks;
  }
  TestWorld world_;
  KnownMap known_;
};

TEST_F(LocalMapTest, ReferenceSharesMostLandmarks) {
  for (const KeyFrameId id : {0u, 5u, 11u})
    EXPECT_EQ(local_map_around(observed_by(id), known_.map, 80).reference, id);
}

TEST_F(LocalMapTest, ElementsExistAndComeOnce) {
  const LocalMap local = local_map_around(observed_by(4), known_.map, 80);
  const std::set<KeyFrameId> keyframes(local.keyframes.begin(), local.keyframes.end());
  const std::set<LandmarkId> landmarks(local.landmarks.begin(), local.landmarks.end());
  EXPECT_EQ(keyframes.size(), local.keyframes.size());
  EXPECT_EQ(landmarks.size(), local.landmarks.size());
  std::set<LandmarkId> expected;
  for (const KeyFrameId id : keyframes)
    for (const LandmarkId landmark : observed_by(id))
      if (landmark != kNoId) expected.insert(landmark);
  EXPECT_EQ(landmarks, expected);
}

TEST_F(LocalMapTest, NeighboursOfNeighboursComeIn) {
  // One landmark leads to key frames that do not see it.
  const std::vector<LandmarkId> first = observed_by(0);
  const LandmarkId lonely =
      *std::find_if(first.begin(), first.end(), [](LandmarkId id) { return id != kNoId; });
  const LocalMap local = local_map_around({lonely}, known_.map, 80);
  EXPECT_GT(local.keyframes.size(), known_.map.landmark(lonely)->observations.size());
}

TEST_F(LocalMapTest, KeepsToTheLimit) {
  const LocalMap local = local_map_around(observed_by(6), known_.map, 3);
  EXPECT_EQ(local.keyframes.size(), 3u);
  EXPECT_EQ(local.keyframes.front(), 6u);
}

TEST_F(LocalMapTest, NothingMatchedNothingFound) {
  for (const auto& matched : {std::vector<LandmarkId>{}, std::vector<LandmarkId>(50, kNoId)}) {
    const LocalMap local = local_map_around(matched, known_.map, 80);
    EXPECT_EQ(local.reference, kNoId);
    EXPECT_TRUE(local.keyframes.empty() && local.landmarks.empty());
  }
}

TEST_F(LocalMapTest, LandmarksThatAreGoneDoNotCount) {
  const std::vector<LandmarkId> matched = observed_by(2);
  MapEdit edit(known_.map);
  for (const LandmarkId id : matched)
    if (id != kNoId) edit.remove_landmark(id);
  EXPECT_EQ(local_map_around(matched, std::move(edit).finish(), 80).reference, kNoId);
}

}  // namespace
}  // namespace stillpoint::orb_slam
