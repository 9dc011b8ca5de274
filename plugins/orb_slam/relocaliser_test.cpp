#include "orb_slam/relocaliser.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kRooms = 24;

// Rooms ten metres apart, one key frame in each, nothing in common.
class RelocaliserTest : public testing::Test {
 protected:
  RelocaliserTest() {
    MapEdit edit{SparseMap{}};
    for (KeyFrameId id = 0; id < kRooms; ++id) {
      const double x = 10.0 * id;
      rooms_.emplace_back(150, id + 1, Box{{x - 1.5, -1, 2}, {x + 1.5, 1, 4}});
      const View view = rooms_.back().render(place(id));
      edit.add_keyframe(keyframe_of(view, id));
      for (std::uint32_t i = 0; i < view.point.size(); ++i) {
        const LandmarkId landmark = edit.add_landmark(
            {.position_in_world = rooms_.back().points()[view.point[i]].position});
        edit.add_observation(landmark, {id, i});
        refresh_landmark(edit, landmark);
      }
      edit.update_covisibility(id);
    }
    map_ = std::move(edit).finish();
  }
  static Pose place(KeyFrameId room) { return pose_at({10.0 * room, 0, 0}); }
  ObservedFrame seen_in(KeyFrameId room) {
    return observed(rooms_[room].render(pose_at({10.0 * room + 0.1, 0.05, 0.1}, {0, 0.1, 0.1})));
  }
  // Calls until it is found, 0 = never within `limit`.
  int calls_to_find(KeyFrameId room, int limit = kRooms) {
    for (int calls = 1; calls <= limit; ++calls) {
      ObservedFrame frame = seen_in(room);
      if (!relocaliser_.find(frame, map_, [] { return true; })) continue;
      EXPECT_EQ(frame.reference, room);
      EXPECT_LT(std::abs(frame.world_from_camera.translation().x() - (10.0 * room + 0.1)), 0.01);
      EXPECT_GT(frame.matched(), 30);
      return calls;
    }
    return 0;
  }
  std::vector<TestWorld> rooms_;
  SparseMap map_;
  Relocaliser relocaliser_;
};

TEST_F(RelocaliserTest, LastPlaceIsFoundAtOnce) {
  for (const KeyFrameId room : {17u, 3u, 23u}) {
    relocaliser_.begin(room);
    EXPECT_EQ(calls_to_find(room), 1);
  }
}

TEST_F(RelocaliserTest, EveryPlaceIsFoundByItsLooks) {
  relocaliser_.begin(12);
  for (const KeyFrameId room : {0u, 20u, 7u, 6u, 23u}) EXPECT_EQ(calls_to_find(room), 1) << room;
}

TEST_F(RelocaliserTest, LastPlaceMayBeGone) {
  relocaliser_.begin(10);
  MapEdit edit(map_);
  edit.remove_keyframe(10);
  map_ = std::move(edit).finish();
  EXPECT_GT(calls_to_find(5), 0);
  EXPECT_EQ(calls_to_find(10), 0) << "nobody knows it any more";
}

// A thing that has been moved may look like the last place.
TEST_F(RelocaliserTest, AfterAPlaceThatIsNotAcceptedTheNextOneIsTried) {
  relocaliser_.begin(3);
  ObservedFrame frame = seen_in(3);
  std::vector<KeyFrameId> tried;
  EXPECT_FALSE(relocaliser_.find(frame, map_, [&] {
    tried.push_back(frame.reference);
    return false;
  }));
  EXPECT_EQ(tried, std::vector<KeyFrameId>{3}) << "nothing else looks like it";
  EXPECT_EQ(frame.matched(), 0);
}

TEST_F(RelocaliserTest, UnknownPlaceIsNeverFound) {
  TestWorld unknown(400, 999);
  ObservedFrame frame = observed(unknown.render(Pose::Identity()));
  for (int i = 0; i < kRooms; ++i)
    EXPECT_FALSE(relocaliser_.find(frame, map_, [] { return true; }));
  EXPECT_EQ(frame.matched(), 0);
}

TEST(RequiredSupport, IsLargerOutOfReach) {
  EXPECT_LT(required_support(0.9, 0), required_support(1.1, 0));
  EXPECT_EQ(required_support(1.1, 1), required_support(0.9, 0)) << "a second later it may be there";
}

TEST_F(RelocaliserTest, WithoutBeginItStillFinds) { EXPECT_GT(calls_to_find(8), 0); }

}  // namespace
}  // namespace stillpoint::orb_slam
