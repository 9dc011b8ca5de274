#include "stillpoint/runtime/map_store.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace stillpoint {
namespace {

SparseMap with_another_keyframe(const SparseMap& map) {
  MapEdit edit(map);
  KeyFrame keyframe{.id = static_cast<KeyFrameId>(map.keyframe_id_end())};
  keyframe.features = std::make_shared<const Features>();
  edit.add_keyframe(std::move(keyframe));
  return std::move(edit).finish();
}

TEST(MapStore, BeginsEmpty) { EXPECT_TRUE(MapStore().snapshot()->empty()); }

TEST(MapStore, SnapshotsStayAsTheyWere) {
  MapStore store;
  const auto before = store.snapshot();
  store.publish(with_another_keyframe(*before));
  EXPECT_EQ(before->keyframe_count(), 0u);
  EXPECT_EQ(store.snapshot()->keyframe_count(), 1u);
}

TEST(MapStore, ReadersSeeWholeVersionsInOrder) {
  MapStore store;
  constexpr std::size_t kVersions = 200;
  std::jthread writer([&] {
    for (std::size_t i = 0; i < kVersions; ++i)
      store.publish(with_another_keyframe(*store.snapshot()));
  });
  std::size_t last = 0;
  while (last < kVersions) {
    const auto map = store.snapshot();
    ASSERT_GE(map->keyframe_count(), last);
    ASSERT_EQ(map->keyframe_count(), map->keyframe_id_end());
    last = map->keyframe_count();
  }
}

TEST(MapStore, WaitsForTheFirstKeyFrame) {
  MapStore store;
  store.publish(SparseMap());  // as cleared
  std::jthread writer([&] { store.publish(with_another_keyframe(*store.snapshot())); });
  EXPECT_TRUE(store.wait_begun({}));
  EXPECT_EQ(store.snapshot()->keyframe_count(), 1u);
}

TEST(MapStore, AStopEndsTheWait) {
  MapStore store;
  std::stop_source stop;
  std::jthread stopper([&] { stop.request_stop(); });
  EXPECT_FALSE(store.wait_begun(stop.get_token()));
}

}  // namespace
}  // namespace stillpoint
