#include "dense_flow_checker.hpp"

#include <gtest/gtest.h>

#include <stillpoint/testing/test_recording.hpp>

namespace {

using stillpoint::testing::TestRecording;

DenseFlowChecker checker() {
  return {DenseFlowChecker::Options{.spacing = 6}, stillpoint::testing::test_context()};
}

TEST(DenseFlowChecker, ThePersonMovesAndTheRoomDoesNot) {
  const TestRecording recording({.frames = 4});
  const auto result = checker().check(*recording.frame(0), *recording.frame(3), {});
  ASSERT_TRUE(result.reliable);
  const cv::Mat labels = recording.segmentation(0)->labels;
  int person = 0, person_moves = 0, room = 0, room_moves = 0;
  for (const stillpoint::PointMotion& point : result.points) {
    const bool on_person = labels.at<std::uint8_t>(point.previous) != 0;
    (on_person ? person : room) += 1;
    if (point.moving) (on_person ? person_moves : room_moves) += 1;
  }
  EXPECT_GT(person, 50);
  EXPECT_GT(person_moves, 0.9 * person);
  EXPECT_GT(room, 500);
  EXPECT_LT(room_moves, 0.01 * room);
}

TEST(DenseFlowChecker, FindsTheMotionOfTheCamera) {
  const TestRecording recording({.frames = 2});
  const auto result = checker().check(*recording.frame(0), *recording.frame(1), {});
  ASSERT_TRUE(result.camera_motion);
  const stillpoint::Pose truth =
      recording.world_from_camera(1).inverse() * recording.world_from_camera(0);
  const stillpoint::Pose error = truth.inverse() * *result.camera_motion;
  EXPECT_LT(error.translation().norm(), 0.005);
  EXPECT_LT(stillpoint::rotation_angle(error), 0.001);
}

TEST(DenseFlowChecker, KnowsNothingWithoutDepth) {
  const TestRecording recording({.frames = 2});
  stillpoint::Frame blind = *recording.frame(1);
  blind.depth = cv::Mat::zeros(blind.depth.size(), CV_32FC1);  // not measured
  EXPECT_FALSE(checker().check(*recording.frame(0), blind, {}).reliable);
}

}  // namespace
