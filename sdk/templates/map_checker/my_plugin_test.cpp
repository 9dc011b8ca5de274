#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stillpoint/testing/test_recording.hpp>
#include <vector>

namespace plugins::my_plugin {
namespace {

using stillpoint::testing::TestRecording;

const TestRecording& recording() {
  static const TestRecording recording({.frames = 12});
  return recording;
}

stillpoint::TrackedFrame tracked(std::size_t i) {
  return {.frame = recording().frame(i),
          .weights = recording().weights(i),
          .world_from_camera = recording().world_from_camera(i)};
}

stillpoint::MapEvidence checked(MyPlugin& checker, std::size_t i, const stillpoint::Frame& frame) {
  const std::vector<stillpoint::Pose> guesses = {recording().world_from_camera(i)};
  return checker.check(frame, guesses, {});
}

TEST(MyPlugin, NothingIsKnownOfTheFirstFrame) {
  MyPlugin checker(MyPlugin::Options{});
  EXPECT_TRUE(checked(checker, 0, *recording().frame(0)).log_odds.empty());
}

TEST(MyPlugin, WhereThePersonHasComeMovesAndTheRoomDoesNot) {
  MyPlugin checker(MyPlugin::Options{});
  for (std::size_t i = 0; i < 11; ++i) checker.remember(tracked(i));
  const cv::Mat evidence = checked(checker, 11, *recording().frame(11)).log_odds;
  ASSERT_EQ(evidence.size(), cv::Size(40, 30));
  cv::Mat labels;
  cv::resize(recording().segmentation(11)->labels, labels, evidence.size(), 0, 0,
             cv::INTER_NEAREST);
  const cv::Mat person = labels != 0, room = labels == 0;
  const cv::Mat moves = evidence > 0, stays = evidence < 0;
  EXPECT_GT(cv::countNonZero(moves & person), 0.3 * cv::countNonZero(person));
  EXPECT_LT(cv::countNonZero(moves & room), 0.03 * cv::countNonZero(room));
  EXPECT_GT(cv::countNonZero(stays & room), 0.6 * cv::countNonZero(room));
  EXPECT_LT(cv::countNonZero(stays & person), 0.1 * cv::countNonZero(person));
}

TEST(MyPlugin, WithoutDepthNothingIsKnown) {
  MyPlugin checker(MyPlugin::Options{});
  checker.remember(tracked(0));
  stillpoint::Frame blind = *recording().frame(1);
  blind.depth = cv::Mat(blind.depth.size(), CV_32FC1, cv::Scalar(0));
  EXPECT_EQ(cv::countNonZero(checked(checker, 1, blind).log_odds), 0);
}

}  // namespace
}  // namespace plugins::my_plugin
