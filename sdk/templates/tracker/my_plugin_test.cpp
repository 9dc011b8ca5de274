#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <stillpoint/testing/test_recording.hpp>
#include <utility>

namespace plugins::my_plugin {
namespace {

using stillpoint::TrackState;
using stillpoint::testing::TestRecording;

/// The map that the program would make: key frames only.
class TrackedRun {
 public:
  stillpoint::TrackResult track(stillpoint::FramePtr frame,
                                const stillpoint::StaticWeights& weights) {
    const auto next = static_cast<stillpoint::KeyFrameId>(map_.keyframe_id_end());
    stillpoint::TrackResult result =
        tracker_.track(tracker_.prepare(std::move(frame)), weights, map_, {.next_keyframe = next});
    if (result.keyframe) {
      stillpoint::MapEdit edit(std::move(map_));
      edit.add_keyframe(*result.keyframe);
      map_ = std::move(edit).finish();
    }
    return result;
  }
  const stillpoint::SparseMap& map() const { return map_; }

 private:
  MyPlugin tracker_{MyPlugin::Options{}, stillpoint::testing::test_context()};
  stillpoint::SparseMap map_;
};

TEST(MyPlugin, FollowsTheCameraPastAPerson) {
  const TestRecording recording({.frames = 25});
  TrackedRun run;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const auto result = run.track(recording.frame(i), *recording.weights(i));
    ASSERT_EQ(result.state, TrackState::kTracking) << "frame " << i;
    const stillpoint::Pose error =
        recording.world_from_camera(i).inverse() * result.world_from_camera;
    EXPECT_LT(error.translation().norm(), 0.03) << "frame " << i;
  }
  EXPECT_GE(run.map().keyframe_count(), 2u);
}

TEST(MyPlugin, UsesNothingOfWeightZero) {
  const TestRecording recording({.frames = 2});
  TrackedRun run;
  run.track(recording.frame(0), *recording.weights(0));
  const auto result = run.track(recording.frame(1), *recording.weights(1));
  const cv::Mat weights = recording.weights(1)->track;
  for (const stillpoint::TrackedFeature& feature : result.tracked)
    if (feature.use == stillpoint::TrackedFeature::Use::kInlier) {
      EXPECT_GT(stillpoint::StaticWeights::at(weights, feature.pixel.x, feature.pixel.y), 0);
    }
  const stillpoint::StaticWeights none{cv::Mat::zeros(weights.size(), CV_8UC1)};
  EXPECT_EQ(run.track(recording.frame(1), none).state, TrackState::kLost);
}

TEST(MyPlugin, WaitsForAFrameWithDepthAndIsLostInTheDark) {
  const TestRecording recording({.frames = 3});
  auto blind = std::make_shared<stillpoint::Frame>(*recording.frame(0));
  blind->depth = cv::Mat(blind->depth.size(), CV_32FC1, cv::Scalar(0));
  auto dark = std::make_shared<stillpoint::Frame>(*recording.frame(1));
  dark->gray = cv::Mat(dark->gray.size(), CV_8UC1, cv::Scalar(0));
  TrackedRun run;
  EXPECT_EQ(run.track(blind, {}).state, TrackState::kWaiting);
  EXPECT_EQ(run.track(recording.frame(0), {}).state, TrackState::kTracking);
  EXPECT_EQ(run.track(dark, {}).state, TrackState::kLost);
  EXPECT_EQ(run.track(recording.frame(2), {}).state, TrackState::kTracking);
}

}  // namespace
}  // namespace plugins::my_plugin
