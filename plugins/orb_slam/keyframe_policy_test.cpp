#include "orb_slam/keyframe_policy.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr TrackHints kIdle{.mapping_waiting = false}, kBusy{.mapping_waiting = true};

// Everything in view of the reference is tracked, far and near.
TrackingQuality good(const KeyFrameOptions& options) {
  return {.inliers = 400,
          .most_inliers = 400,
          .close_tracked = options.min_close + 100,
          .close_untracked = 0,
          .seconds_since_last = 0.1};
}

TEST(NeedsKeyFrame, NotWhileTheViewIsKnown) {
  const KeyFrameOptions options;
  EXPECT_FALSE(needs_keyframe(good(options), kIdle, options));
}

TEST(NeedsKeyFrame, WhenTheViewHasChanged) {
  const KeyFrameOptions options;
  TrackingQuality quality = good(options);
  quality.inliers = static_cast<int>(options.min_tracked_ratio * quality.most_inliers) - 5;
  EXPECT_TRUE(needs_keyframe(quality, kIdle, options));
  quality.inliers += 10;
  EXPECT_FALSE(needs_keyframe(quality, kIdle, options));
}

TEST(NeedsKeyFrame, InUnseenRoomTheReferenceSharesFewLandmarks) {
  const KeyFrameOptions options;
  TrackingQuality quality = good(options);
  quality.established = quality.most_inliers / 2;
  quality.inliers = static_cast<int>(options.min_tracked_ratio * quality.most_inliers) - 5;
  EXPECT_TRUE(needs_keyframe(quality, kIdle, options));
  std::swap(quality.established, quality.most_inliers);
  EXPECT_TRUE(needs_keyframe(quality, kIdle, options)) << "what others see may be in view again";
}

TEST(NeedsKeyFrame, WhenTheViewHasChangedALittleAndTheCameraHasMoved) {
  const KeyFrameOptions options;
  ASSERT_GT(options.moved_tracked_ratio, options.min_tracked_ratio);
  TrackingQuality quality = good(options);
  quality.inliers = static_cast<int>(options.moved_tracked_ratio * quality.most_inliers) - 5;
  quality.motion = 0.9 * options.moved;
  EXPECT_FALSE(needs_keyframe(quality, kIdle, options));
  quality.motion = 1.1 * options.moved;
  EXPECT_TRUE(needs_keyframe(quality, kIdle, options));
  EXPECT_FALSE(needs_keyframe(quality, kBusy, options));
  quality.inliers += 10;
  EXPECT_FALSE(needs_keyframe(quality, kIdle, options)) << "nothing has changed";
}

TEST(NeedsKeyFrame, WhenNearPointsRunOut) {
  const KeyFrameOptions options;
  TrackingQuality quality = good(options);
  quality.close_tracked = options.min_close - 1;
  EXPECT_FALSE(needs_keyframe(quality, kIdle, options)) << "no others are there";
  quality.close_untracked = options.max_close_untracked + 1;
  EXPECT_TRUE(needs_keyframe(quality, kIdle, options));
  EXPECT_TRUE(needs_keyframe(quality, kBusy, options)) << "it is urgent";
  quality.seconds_since_last = 0.07;
  EXPECT_TRUE(needs_keyframe(quality, kIdle, options));
  EXPECT_FALSE(needs_keyframe(quality, kBusy, options)) << "or the queue would fill";
}

TEST(NeedsKeyFrame, NeverFromAPoorPose) {
  const KeyFrameOptions options;
  TrackingQuality quality = good(options);
  quality.inliers = options.min_inliers - 1;
  quality.close_tracked = 0;
  quality.close_untracked = 500;
  quality.seconds_since_last = 1000;
  EXPECT_FALSE(needs_keyframe(quality, kIdle, options));
}

TEST(NeedsKeyFrame, BusyMapperIsSparedUnlessItIsUrgentOrLongAgo) {
  const KeyFrameOptions options;
  TrackingQuality quality = good(options);
  quality.inliers = static_cast<int>(options.min_tracked_ratio * quality.most_inliers) - 5;
  EXPECT_FALSE(needs_keyframe(quality, kBusy, options));
  quality.seconds_since_last = options.max_seconds_between;
  EXPECT_TRUE(needs_keyframe(quality, kBusy, options));
  quality.seconds_since_last = 0.03;
  quality.inliers = 20;
  EXPECT_TRUE(needs_keyframe(quality, kBusy, options)) << "tracking is nearly lost";
}

class TrackingQualityTest : public testing::Test {
 protected:
  TestWorld world_;
  View view_ = world_.render(walk(0));
  KnownMap known_ = known_map(world_, {view_, world_.render(walk(2)), world_.render(walk(4))});
  ObservedFrame frame_ = observed(view_);
  KeyFrameOptions options_;
};

TEST_F(TrackingQualityTest, CountsNearPointsByWhetherTheyAreTracked) {
  frame_.landmarks = known_.map.keyframe(0)->landmarks;
  int close = 0;
  for (std::uint32_t i = 0; i < frame_.landmarks.size(); ++i) {
    if (view_.features->depth[i] > options_.close_depth) continue;
    ++close;
    if (close <= 10)
      frame_.landmarks[i] = kNoId;
    else if (close <= 15)
      frame_.outlier[i] = true;
    else if (close <= 18)
      frame_.track_weights[i] = 0;
    else if (close <= 21) {  // on something that is used, but never mapped
      frame_.landmarks[i] = kNoId;
      frame_.map_weights[i] = 0;
    }
  }
  ASSERT_GT(close, 25);
  const TrackingQuality quality = tracking_quality(frame_, known_.map, 123, 0.7, options_);
  EXPECT_EQ(quality.inliers, 123);
  EXPECT_EQ(quality.seconds_since_last, 0.7);
  EXPECT_EQ(quality.close_untracked, 15) << "without landmark, or an outlier";
  EXPECT_EQ(quality.close_tracked, close - 21) << "what cannot be mapped counts nowhere";
}

TEST_F(TrackingQualityTest, CountsWellEstablishedLandmarksOfTheReference) {
  frame_.reference = 0;
  int established = 0;
  for (const LandmarkId id : known_.map.keyframe(0)->landmarks)
    established += id != kNoId && known_.map.landmark(id)->observations.size() >= 2;
  const TrackingQuality quality = tracking_quality(frame_, known_.map, 0, 0, options_);
  EXPECT_EQ(quality.established, established);
  EXPECT_LT(established, static_cast<int>(view_.features->size()));
}

TEST_F(TrackingQualityTest, MotionIsTheWayInDepthsPlusTheRotation) {
  frame_.reference = 0;
  frame_.world_from_camera = known_.map.world_from_keyframe(0);
  EXPECT_NEAR(tracking_quality(frame_, known_.map, 0, 0, options_).motion, 0, 1e-9);
  frame_.world_from_camera = frame_.world_from_camera * exp_se3({0, 0, 0, 0, 0.2, 0});
  EXPECT_NEAR(tracking_quality(frame_, known_.map, 0, 0, options_).motion, 0.2, 1e-9);
  std::vector<float> depths = view_.features->depth;
  std::erase_if(depths, [](float z) { return z <= 0; });
  std::ranges::sort(depths);
  const double depth = depths[depths.size() / 2];
  frame_.world_from_camera.translation().x() += 0.1 * depth;
  EXPECT_NEAR(tracking_quality(frame_, known_.map, 0, 0, options_).motion, 0.3, 1e-6);
}

TEST_F(TrackingQualityTest, WithoutReferenceThereIsNothingToCompareWith) {
  const TrackingQuality quality = tracking_quality(frame_, SparseMap{}, 0, 0, options_);
  EXPECT_EQ(quality.established, 0);
  EXPECT_EQ(quality.motion, 0);
}

TEST(MostInliers, GrowWithOneReferenceAndBeginAnewWithTheNext) {
  MostInliers most;
  EXPECT_EQ(most.update(kNoId, 100), 100);
  EXPECT_EQ(most.update(3, 80), 80);
  EXPECT_EQ(most.update(3, 120), 120);
  EXPECT_EQ(most.update(3, 90), 120);
  EXPECT_EQ(most.update(4, 60), 60);
  EXPECT_EQ(most.update(3, 70), 70) << "now seen from elsewhere";
}

}  // namespace
}  // namespace stillpoint::orb_slam
