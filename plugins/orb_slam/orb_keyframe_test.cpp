#include "orb_slam/orb_keyframe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orb_slam/local_mapper.hpp"
#include "orb_slam/loop_closer.hpp"
#include "orb_slam/scale_pyramid.hpp"
#include "orb_slam/tracker.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::orb_slam {
namespace {

/// Of a tracker with descriptors of its own.
KeyFrame of_another_tracker() {
  KeyFrame keyframe{.id = 0};
  keyframe.camera = std::make_shared<const Camera>();
  keyframe.features =
      std::make_shared<const Features>(Features{.keypoints = {{10, 10, 1}}, .depth = {1}});
  keyframe.track_weights = keyframe.map_weights = {255};
  keyframe.landmarks = {kNoId};
  return keyframe;
}

TEST(OrbKeyFrame, LocalMappingRefusesThoseOfOtherTrackers) {
  OrbLocalMapper mapper({}, {});
  EXPECT_THAT(
      [&] { mapper.insert({}, of_another_tracker()); },
      ::testing::ThrowsMessage<Error>(::testing::HasSubstr("features without ORB descriptors")));
}

TEST(OrbKeyFrame, TrackingRefusesMapsOfOtherTrackers) {
  MapEdit map{SparseMap()};
  map.add_keyframe(of_another_tracker());
  EXPECT_THROW(require_orb(map.map()), Error);
  OrbTracker tracker{OrbTracker::Options()};
  auto frame = std::make_shared<Frame>();
  frame->camera = std::make_shared<const Camera>();
  frame->gray = cv::Mat::zeros(480, 640, CV_8UC1);
  frame->bgr = cv::Mat::zeros(480, 640, CV_8UC3);
  frame->depth = cv::Mat::zeros(480, 640, CV_32FC1);
  auto prepared = tracker.prepare(frame);
  EXPECT_THROW(tracker.track(std::move(prepared), {}, map.map(), {}), Error);
}

TEST(OrbKeyFrame, LoopClosingRefusesThoseOfOtherTrackers) {
  MapEdit map{SparseMap()};
  KeyFrame keyframe = of_another_tracker();
  map.add_keyframe(std::move(keyframe));
  map.add_observation(map.add_landmark({.reference = 0}), {.keyframe = 0, .feature = 0});
  OrbLoopCloser closer({}, {});
  EXPECT_THROW(closer.close(map.map(), 0, {}), Error);
}

TEST(OrbKeyFrame, WithoutFeaturesThereIsNothingToRefuse) {
  KeyFrame keyframe{.id = 0};
  keyframe.features = std::make_shared<const Features>();
  EXPECT_NO_THROW(require_orb(keyframe));
}

// A saved map may have up to 64 levels and right checksums.
TEST(OrbKeyFrame, PyramidsOfOtherTrackersAreRefused) {
  const auto with_pyramid = [](int levels, double factor) {
    Features features{.keypoints = {{10, 10, 1}}, .descriptors = {{}}, .depth = {1}};
    features.keypoints[0].octave = levels - 1;
    features.levels = levels;
    features.scale_factor = factor;
    KeyFrame keyframe = of_another_tracker();
    keyframe.features = std::make_shared<const Features>(std::move(features));
    return keyframe;
  };
  for (const int levels : {1, 8, 16}) EXPECT_NO_THROW(require_orb(with_pyramid(levels, 1.2)));
  for (const int levels : {-1, 0, 17, 64}) {
    OrbLocalMapper mapper({}, {});
    EXPECT_THAT([&] { mapper.insert({}, with_pyramid(levels, 1.2)); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr(
                    "of " + std::to_string(levels) + " pyramid levels, not of 1 to 16")));
    // Of a key frame that was in a map before.
    EXPECT_THROW(ScalePyramid(*with_pyramid(levels, 1.2).features), Error);
  }
}

}  // namespace
}  // namespace stillpoint::orb_slam
