#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <stillpoint/testing/test_recording.hpp>

namespace plugins::my_plugin {
namespace {

using stillpoint::testing::TestRecording;

MyPlugin checker() { return {MyPlugin::Options{}, stillpoint::testing::test_context()}; }

TEST(MyPlugin, PointsOnThePersonMoveAndOthersDoNot) {
  const TestRecording recording({.frames = 4});
  const auto result = checker().check(*recording.frame(0), *recording.frame(3), {});
  ASSERT_TRUE(result.reliable);
  const cv::Mat labels = recording.segmentation(0)->labels;
  int people = 0, moving_people = 0, others = 0, moving_others = 0;
  for (const stillpoint::PointMotion& point : result.points) {
    const bool person = labels.at<std::uint8_t>(point.previous) != 0;
    (person ? people : others) += 1;
    if (point.moving) (person ? moving_people : moving_others) += 1;
  }
  EXPECT_GT(people, 10);
  EXPECT_GT(moving_people, 0.8 * people);
  EXPECT_LT(moving_others, 0.1 * others);
}

TEST(MyPlugin, FindsTheMotionOfTheCamera) {
  const TestRecording recording({.frames = 4, .person = false});
  const auto result = checker().check(*recording.frame(0), *recording.frame(3), {});
  ASSERT_TRUE(result.camera_motion);
  const stillpoint::Pose truth =
      recording.world_from_camera(3).inverse() * recording.world_from_camera(0);
  const stillpoint::Pose error = truth.inverse() * *result.camera_motion;
  EXPECT_LT(error.translation().norm(), 0.01);
  EXPECT_LT(stillpoint::rotation_angle(error), 0.005);
}

TEST(MyPlugin, IsNotReliableWithoutDepthOrTexture) {
  const TestRecording recording({.frames = 2});
  stillpoint::Frame previous = *recording.frame(0);
  previous.depth = cv::Mat(previous.depth.size(), CV_32FC1, cv::Scalar(0));
  EXPECT_FALSE(checker().check(previous, *recording.frame(1), {}).reliable);
  previous = *recording.frame(0);
  previous.gray = cv::Mat(previous.gray.size(), CV_8UC1, cv::Scalar(0));
  EXPECT_FALSE(checker().check(previous, *recording.frame(1), {}).reliable);
}

}  // namespace
}  // namespace plugins::my_plugin
