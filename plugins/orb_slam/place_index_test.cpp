#include "orb_slam/place_index.hpp"

#include <gtest/gtest.h>

#include <random>

#include "orb_slam/test_round_trip.hpp"

namespace stillpoint::orb_slam {
namespace {

std::vector<KeyFrameId> ids(const std::vector<PlaceVote>& votes) {
  std::vector<KeyFrameId> result;
  for (const PlaceVote& vote : votes) result.push_back(vote.keyframe);
  return result;
}

class PlaceIndexTest : public testing::Test {
 protected:
  PlaceIndexTest() { index_.update(map_); }
  std::vector<PlaceVote> query(KeyFrameId id) const {
    return index_.query(place_descriptors(*map_.keyframe(id)));
  }
  SparseMap map_ = RoundTrip().map();
  PlaceIndex index_;
};

TEST_F(PlaceIndexTest, AKeyFrameIsMostLikeItself) {
  for (KeyFrameId id = 0; id < map_.keyframe_id_end(); ++id)
    EXPECT_EQ(query(id).front().keyframe, id);
}

TEST_F(PlaceIndexTest, NoisyDescriptorsOfOnePlaceAreFound) {
  const std::vector<KeyFrameId> found = ids(query(RoundTrip::kPerTurn));
  ASSERT_GE(found.size(), 8U);
  for (const KeyFrameId like : {0U, 1U, 35U})
    EXPECT_LT(std::ranges::find(found, like) - found.begin(), 8) << like;
  EXPECT_EQ(std::ranges::find(found, 18U), found.end()) << "looks the other way";
}

TEST_F(PlaceIndexTest, RemovedKeyFramesAreNotFound) {
  MapEdit edit(map_);
  for (KeyFrameId id = 1; id < 36; ++id) edit.remove_keyframe(id);
  index_.update(std::move(edit).finish());
  EXPECT_EQ(index_.size(), map_.keyframe_count() - 35);
  for (const PlaceVote& vote : query(20)) EXPECT_TRUE(vote.keyframe == 0 || vote.keyframe >= 36);
}

TEST_F(PlaceIndexTest, UnknownViewsGetFewVotes) {
  std::mt19937_64 random(8);
  std::vector<Descriptor> view(500);
  for (Descriptor& d : view) d = {random(), random(), random(), random()};
  EXPECT_TRUE(index_.query(view).empty());
}

TEST(PlaceIndex, EmptyFindsNothing) {
  PlaceIndex index;
  index.update(SparseMap{});
  EXPECT_TRUE(index.query(std::vector<Descriptor>(3)).empty());
}

}  // namespace
}  // namespace stillpoint::orb_slam
