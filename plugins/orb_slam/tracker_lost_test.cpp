// Cameras that are lost, and found again.
#include <gtest/gtest.h>

#include "orb_slam/tracker_fixture.hpp"

namespace stillpoint::orb_slam {
namespace {

using LostCamera = TrackerTest;

TEST_F(LostCamera, DepthTracksOnAfterAMomentWithoutIt) {
  const auto truth = [](int i) { return pose_at({-0.01 * i, 0.003 * i, 0.006 * i}); };
  const auto see = [&](int i, bool covered) {
    auto frame = std::make_shared<Frame>(
        *render_planes({kAhead, kRight, kFloor}, truth(i), static_cast<std::uint32_t>(i), 0.002));
    if (covered) frame->depth.setTo(0);
    return step(frame);
  };
  for (int i = 0; i < 10; ++i) expect_at(see(i, false), truth(i));
  for (int i = 10; i < 13; ++i) EXPECT_EQ(see(i, true).state, TrackState::kLost);
  for (int i = 13; i < 20; ++i) {
    SCOPED_TRACE(i);
    expect_at(see(i, false), truth(i));
  }
  for (int i = 20; i < 55; ++i) see(i, true);
  EXPECT_EQ(see(55, false).state, TrackState::kLost) << "after a second it may be anywhere";
}

/// A corner of a room with pictures on its walls.
FramePtr textured_corner(std::uint32_t index) {
  static const cv::Mat texture = [] {
    cv::Mat image(480, 640, CV_8UC1);
    cv::RNG(3).fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(image, image, {}, 2);
    cv::normalize(image, image, 0, 255, cv::NORM_MINMAX);
    return image;
  }();
  auto frame = std::make_shared<Frame>(
      *render_planes({kAhead, kRight, kFloor}, Pose::Identity(), index, 0.002));
  frame->gray = texture;
  return frame;
}

// As while the exposure settles: depth comes before texture.
TEST_F(LostCamera, AMapBegunOnSurfacesGoesOnWhenTextureAppears) {
  const FramePtr dark = render_planes({kAhead, kRight, kFloor}, Pose::Identity(), next_++, 0.002);
  ASSERT_EQ(step(dark).features, 0);
  for (int i = 0; i < 3; ++i) {
    const TrackResult result = step(textured_corner(next_++));
    EXPECT_GT(result.features, 600);
    expect_at(result, Pose::Identity());
  }
}

// In a map from a file, which has no depth images.
TEST_F(LostCamera, DepthTracksOnInALoadedMap) {
  for (int i = 0; i < 10; ++i) step(textured_corner(next_++));
  tracker_ = OrbTracker{OrbTracker::Options{}};
  localise_only_ = true;
  for (int i = 0; i < 3; ++i) expect_at(step(textured_corner(next_++)), Pose::Identity());
  for (int i = 0; i < 10; ++i) {
    const Pose truth = pose_at({-0.01 * i, 0, 0.005 * i});
    const TrackResult result = step(render_planes({kAhead, kRight, kFloor}, truth, next_++, 0.002));
    expect_at(result, truth);
    EXPECT_TRUE(result.depth_registered);
    EXPECT_FALSE(result.keyframe);
  }
}

TEST_F(LostCamera, BlackFrameIsLostAndThenFoundAgain) {
  for (int i = 0; i < 5; ++i) expect_at(step(pose_at({0.02 * i, 0, 0})), pose_at({0.02 * i, 0, 0}));
  for (int i = 0; i < 3; ++i) {
    const TrackResult result = step(scene_.black(next_++));
    EXPECT_EQ(result.state, TrackState::kLost);
    EXPECT_FALSE(result.keyframe);
  }
  for (int i = 5; i < 10; ++i) {
    SCOPED_TRACE(i);
    expect_at(step(pose_at({0.02 * i, 0, 0})), pose_at({0.02 * i, 0, 0}));
  }
}

TEST_F(LostCamera, LostFarAwayIsFoundWhereTheMapIsKnown) {
  for (int i = 0; i < 20; ++i) step(pose_at({0.05 * i, 0, 0}));
  EXPECT_EQ(step(scene_.black(next_++)).state, TrackState::kLost);
  TrackResult result;
  for (int i = 0; i < 20 && result.state != TrackState::kTracking; ++i)
    result = step(pose_at({0.03, 0.02, 0}));
  expect_at(result, pose_at({0.03, 0.02, 0}));
}

TEST_F(LostCamera, AThingThatHasBeenMovedIsNoPlace) {
  for (int i = 0; i < 8; ++i) step(pose_at({0.02 * i, 0, 0}));
  step(scene_.black(next_++));
  // Only the nearer of the two things is left, half a metre farther to the right.
  const Panel nowhere{100, 100, 1, 1, 3};
  const TestScene moved({nowhere, nowhere, {0.9, -0.2, 0.9, 1.2, 1.8}});
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(step(moved.render(pose_at({0.5, 0, 0}), next_++)).state, TrackState::kLost) << i;
  expect_at(step(pose_at({0.1, 0, 0})), pose_at({0.1, 0, 0}));
}

TEST_F(LostCamera, RelocalisationMustHoldBeforeTheMapGrows) {
  for (int i = 0; i < 8; ++i) step(pose_at({0.02 * i, 0, 0}));
  step(scene_.black(next_++));
  const Pose aside = pose_at({0.9, 0, 0});  // half of what is in view is not in the map yet
  const std::uint32_t found = next_;
  bool has_keyframe = false;
  for (int i = 0; i < 12; ++i) {
    const bool early = next_ - found < 6;  // 0.2 s at 30 Hz
    const TrackResult result = step(aside);
    expect_at(result, aside);
    EXPECT_FALSE(early && result.keyframe) << i;
    has_keyframe |= result.keyframe.has_value();
  }
  EXPECT_TRUE(has_keyframe);
}

TEST_F(LostCamera, UnknownViewIsLost) {
  for (int i = 0; i < 5; ++i) step(pose_at({0.02 * i, 0, 0}));
  EXPECT_EQ(step(TestScene({{-6, -6, 15, 15, 2.7}}).render(pose_at({3, 3, 0}), next_++)).state,
            TrackState::kLost);
}

// As where a hand was before the lens, or the camera was still being put into place.
TEST_F(LostCamera, AMapThatIsLostAtOnceIsBegunAnew) {
  may_begin_anew_ = true;
  const TestScene elsewhere({{-6, -6, 15, 15, 2.7}});
  constexpr int kTracked = 45, kAfterwards = 20;  // frames of 1/30 s
  for (int i = 0; i < kTracked; ++i)
    expect_at(step(elsewhere.render(pose_at({0.01 * i, 0, 0}), next_++)),
              pose_at({0.01 * i, 0, 0}));
  const std::size_t keyframes = map_.keyframe_id_end();

  int lost = 0;
  TrackResult result = step(pose_at({0, 0, 0}));
  for (; result.state == TrackState::kLost && lost < 2 * kTracked; ++lost)
    result = step(pose_at({0, 0, 0}));
  EXPECT_NEAR(lost, kTracked, 2);
  EXPECT_TRUE(result.begins_anew);
  ASSERT_TRUE(result.keyframe);
  EXPECT_EQ(result.keyframe->id, keyframes);
  EXPECT_TRUE(result.keyframe->landmarks == std::vector(result.keyframe->landmarks.size(), kNoId));
  for (int i = 0; i < kAfterwards; ++i) {
    SCOPED_TRACE(i);
    result = step(pose_at({0.03 * i, 0, 0.01 * i}));
    expect_at(result, pose_at({0.03 * i, 0, 0.01 * i}));
    EXPECT_FALSE(result.begins_anew);
  }
  EXPECT_EQ(map_.keyframe_id_begin(), keyframes);
  EXPECT_GT(map_.keyframe_count(), 1u);
  EXPECT_TRUE(map_.world_from_keyframe(map_.keyframe_id_begin()).isApprox(Pose::Identity()))
      << "bundle adjustment leaves the origin where it is";
}

TEST_F(LostCamera, DarknessAndGapsAreNoReasonToGiveUpAMap) {
  may_begin_anew_ = true;
  for (int i = 0; i < 10; ++i) step(pose_at({0.01 * i, 0, 0}));
  for (int i = 0; i < 90; ++i) EXPECT_EQ(step(scene_.black(next_++)).state, TrackState::kLost);
  next_ += 300;
  const TestScene elsewhere({{-6, -6, 15, 15, 2.7}});
  for (int i = 0; i < 3; ++i)  // as with motion blur
    EXPECT_EQ(step(elsewhere.render(pose_at({3, 3, 0}), next_++)).state, TrackState::kLost) << i;
  TrackResult result;
  for (int i = 0; i < 20 && result.state != TrackState::kTracking; ++i)
    result = step(pose_at({0.05, 0, 0}));
  expect_at(result, pose_at({0.05, 0, 0}));
  EXPECT_FALSE(result.begins_anew);
}

TEST_F(LostCamera, AMapOfTenSecondsIsNeverGivenUp) {
  may_begin_anew_ = true;
  for (int i = 0; i <= 300; ++i) step(pose_at({0, 0, 0}));
  const TestScene elsewhere({{-6, -6, 15, 15, 2.7}});
  for (int i = 0; i < 400; i += 20) {
    next_ += 20;
    EXPECT_EQ(step(elsewhere.render(pose_at({3, 3, 0}), next_)).state, TrackState::kLost) << i;
  }
}

TEST_F(LostCamera, ALoadedMapIsNeverGivenUp) {
  for (int i = 0; i < 5; ++i) step(pose_at({0.02 * i, 0, 0}));
  const TestScene elsewhere({{-6, -6, 15, 15, 2.7}});
  for (int i = 0; i < 60; ++i)
    EXPECT_EQ(step(elsewhere.render(pose_at({3, 3, 0}), next_++)).state, TrackState::kLost) << i;
}

TEST_F(LostCamera, JumpIsFoundByAppearance) {
  for (int i = 0; i < 6; ++i) step(pose_at({0.01 * i, 0, 0}));
  const Pose jump = pose_at({0.25, 0.1, 0.1}, {0.05, 0.15, 0.2});
  expect_at(step(jump), jump);
  expect_at(step(pose_at({0.01, 0, 0})), pose_at({0.01, 0, 0}));
}

}  // namespace
}  // namespace stillpoint::orb_slam
