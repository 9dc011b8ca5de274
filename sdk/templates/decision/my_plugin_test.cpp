#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stillpoint/testing/test_recording.hpp>

namespace plugins::my_plugin {
namespace {

using stillpoint::testing::TestRecording;

const TestRecording& recording() {
  static const TestRecording recording({.frames = 3});
  return recording;
}

MyPlugin decision() { return {MyPlugin::Options{}, stillpoint::testing::test_context()}; }

cv::Mat person() { return recording().segmentation(2)->labels != 0; }

TEST(MyPlugin, APersonWhoMovesIsNeitherTrackedNorMapped) {
  const auto weights = decision().decide(*recording().frame(2), *recording().segmentation(2),
                                         recording().moving_points(2), {});
  EXPECT_EQ(cv::countNonZero(weights.track & person()), 0);
  EXPECT_EQ(cv::countNonZero(weights.map & person()), 0);
  EXPECT_GT(cv::countNonZero(weights.track), 0.8 * cv::countNonZero(~person()));
  EXPECT_TRUE(weights.object_moves.at(0));
}

TEST(MyPlugin, APersonWhoStandsStillIsTrackedButNotMapped) {
  stillpoint::MovingPoints moving = recording().moving_points(2);
  for (stillpoint::PointMotion& point : moving.points) point.moving = false;
  const auto weights =
      decision().decide(*recording().frame(2), *recording().segmentation(2), moving, {});
  EXPECT_EQ(cv::countNonZero(weights.track != 255), 0);
  EXPECT_EQ(cv::countNonZero(weights.map & person()), 0);
  EXPECT_FALSE(weights.object_moves.at(0));
}

TEST(MyPlugin, WithoutMovingPointsPeopleMove) {
  const auto weights =
      decision().decide(*recording().frame(0), *recording().segmentation(0), {}, {});
  EXPECT_TRUE(weights.object_moves.at(0));
}

TEST(MyPlugin, WithoutLabelsOnlyMovingPointsCount) {
  const auto weights = decision().decide(*recording().frame(0), {}, {}, {});
  EXPECT_EQ(cv::countNonZero(weights.track != 255), 0);
  EXPECT_TRUE(weights.object_moves.empty());
}

TEST(MyPlugin, RefusesALabelThatTheSegmenterDoesNotHave) {
  EXPECT_THROW(MyPlugin({.labels = {"unicorn"}}, stillpoint::testing::test_context()),
               stillpoint::Error);
}

}  // namespace
}  // namespace plugins::my_plugin
