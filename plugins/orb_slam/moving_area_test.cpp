#include "orb_slam/moving_area.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace stillpoint::orb_slam {
namespace {

StaticWeights with_moving_columns(int columns) {
  StaticWeights weights;
  weights.track = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  if (columns > 0) weights.track.colRange(0, columns).setTo(0);
  return weights;
}

TEST(MovingArea, WithoutWeightsNothingMoves) {
  MovingArea area;
  area.update({}, 1.0);
  EXPECT_TRUE(area.mask().empty());
  EXPECT_EQ(area.feature_factor(4.0), 1.0);
  EXPECT_FALSE(area.recent(1.0));
}

TEST(MovingArea, TheRestNeedsMoreFeatures) {
  MovingArea area;
  area.update(with_moving_columns(328), 1.0);  // 8 of them may be uncovered in the next frame
  EXPECT_EQ(cv::countNonZero(area.mask()), 320 * 480);
  EXPECT_NEAR(area.feature_factor(10.0), 4.0, 1e-9);
  EXPECT_EQ(area.feature_factor(2.0), 2.0);
}

TEST(MovingArea, WhatIsUncoveredGrowsWithTheImage) {
  StaticWeights weights;
  weights.track = cv::Mat(240, 320, CV_8UC1, cv::Scalar(255));
  weights.track.colRange(0, 164).setTo(0);
  MovingArea area;
  area.update(weights, 1.0);
  EXPECT_EQ(cv::countNonZero(area.mask()), 160 * 240);
}

TEST(MovingArea, WhatHasLeftIsRememberedForSeconds) {
  MovingArea area;
  area.update(with_moving_columns(328), 1.0);
  area.update(with_moving_columns(14), 3.0);  // 1 %: noise of a mask
  EXPECT_TRUE(area.recent(3.0));
  EXPECT_TRUE(area.recent(5.9));
  EXPECT_FALSE(area.recent(6.1));
}

}  // namespace
}  // namespace stillpoint::orb_slam
