#include "orb_slam/loop_closer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "orb_slam/test_round_trip.hpp"

namespace stillpoint::orb_slam {
namespace {

class LoopCloserTest : public testing::Test {
 protected:
  // Key frame after key frame, until a loop is closed or the trip is over.
  std::optional<MapCorrection> go() {
    for (last_ = 0; last_ < RoundTrip::kKeyFrames; ++last_) {
      map_ = trip_.map(last_ + 1);
      if (auto correction = closer_.close(map_, static_cast<KeyFrameId>(last_), {}))
        return correction;
    }
    return std::nullopt;
  }

  RoundTrip trip_;
  OrbLoopCloser closer_{{}, StageContext{}};
  SparseMap map_;
  int last_ = 0;
};

TEST_F(LoopCloserTest, ClosesTheLoopOnceThePlaceIsSeenAgain) {
  const auto correction = go();
  ASSERT_TRUE(correction);
  EXPECT_GE(last_, RoundTrip::kPerTurn - 4);
  const SparseMap closed = apply(*correction, map_);
  EXPECT_EQ(closed.check(), std::nullopt);
  EXPECT_LT(worst_metres(closed), 0.75 * worst_metres(map_));
  EXPECT_LT(closed.landmark_count(), map_.landmark_count() - 100);
  EXPECT_LT(metres_between(closed.world_from_keyframe(static_cast<KeyFrameId>(last_)),
                           RoundTrip::truth(last_)),
            0.03);
}

TEST_F(LoopCloserTest, ALoopOfAMapThatWasClearedIsForgotten) {
  const auto first = go();
  ASSERT_TRUE(first);
  MapEdit edit(map_);
  edit.clear();
  const SparseMap cleared = std::move(edit).finish();
  const auto begin = static_cast<KeyFrameId>(cleared.keyframe_id_end());
  std::optional<MapCorrection> second;
  for (int i = 0; i < RoundTrip::kKeyFrames && !second; ++i) {
    map_ = trip_.map(i + 1, cleared);
    second = closer_.close(map_, begin + static_cast<KeyFrameId>(i), {});
  }
  ASSERT_TRUE(second);
  ASSERT_EQ(second->moved.size(), first->moved.size());
  for (std::size_t i = 0; i < second->moved.size(); ++i)
    EXPECT_TRUE(second->moved[i].world_from_camera.isApprox(first->moved[i].world_from_camera))
        << i;
}

TEST_F(LoopCloserTest, AdjustmentMakesTheMapConsistent) {
  const auto correction = go();
  ASSERT_TRUE(correction);
  const SparseMap closed = apply(*correction, map_);
  const auto adjusted = closer_.adjust(closed, {});
  ASSERT_TRUE(adjusted);
  const SparseMap map = apply(*adjusted, closed);
  EXPECT_EQ(map.check(), std::nullopt);
  EXPECT_LT(worst_metres(map), 0.5 * worst_metres(closed));
}

TEST_F(LoopCloserTest, WithoutReturnThereIsNoLoop) {
  for (int i = 0; i < RoundTrip::kPerTurn - 6; ++i) {
    const SparseMap map = trip_.map(i + 1);
    EXPECT_FALSE(closer_.close(map, static_cast<KeyFrameId>(i), {})) << i;
  }
}

// As between two rooms that look the same.
TEST_F(LoopCloserTest, APlaceOutOfReachIsNone) {
  const RoundTrip far_off(0.02);  // 0.8 m at the end of a way of 6.3 m
  const auto closes = [&](double max_drift) {
    OrbLoopCloser closer({.max_drift = max_drift}, StageContext{});
    for (int i = 0; i < RoundTrip::kKeyFrames; ++i)
      if (closer.close(far_off.map(i + 1), static_cast<KeyFrameId>(i), {})) return true;
    return false;
  };
  EXPECT_FALSE(closes(0.01));
  EXPECT_TRUE(closes(0.1));
}

// As where opposite sides of a room look the same, seen from its middle.
TEST_F(LoopCloserTest, APlaceThatTurnsTheCameraRoundIsNone) {
  for (last_ = 0; last_ < RoundTrip::kKeyFrames; ++last_) {
    MapEdit edit(trip_.map(last_ + 1));
    const auto id = static_cast<KeyFrameId>(last_);
    if (last_ > RoundTrip::kPerTurn / 2)
      edit.keyframe(id).world_from_camera.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()));
    EXPECT_FALSE(closer_.close(std::move(edit).finish(), id, {})) << last_;
  }
}

// Along a blank corridor, where tracking had only depth.
TEST_F(LoopCloserTest, UncertainKeyFramesAllowLargerCorrections) {
  const RoundTrip far_off(0.02);  // 0.8 m at the end of a way of 6.3 m
  const auto closes = [&](double sigma) {
    OrbLoopCloser closer({.max_drift = 0}, StageContext{});
    for (int i = 0; i < RoundTrip::kKeyFrames; ++i) {
      MapEdit edit(far_off.map(i + 1));
      for (KeyFrameId id = 10; id < static_cast<KeyFrameId>(std::min(i, 20)); ++id)
        edit.keyframe(id).covariance.diagonal().setConstant(sigma * sigma);
      if (closer.close(std::move(edit).finish(), static_cast<KeyFrameId>(i), {})) return true;
    }
    return false;
  };
  EXPECT_FALSE(closes(0.001));
  EXPECT_TRUE(closes(0.1));
}

TEST_F(LoopCloserTest, AStopEndsTheSearch) {
  std::stop_source stop;
  stop.request_stop();
  for (int i = 0; i < RoundTrip::kKeyFrames; ++i)
    EXPECT_FALSE(closer_.close(trip_.map(i + 1), static_cast<KeyFrameId>(i), stop.get_token()));
}

TEST_F(LoopCloserTest, AKeyFrameThatIsGoneClosesNothing) {
  MapEdit edit(trip_.map());
  edit.remove_keyframe(40);
  EXPECT_FALSE(closer_.close(std::move(edit).finish(), 40, {}));
}

}  // namespace
}  // namespace stillpoint::orb_slam
