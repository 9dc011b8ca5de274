#include "map_checks/depth_cells.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace stillpoint::map_checks {
namespace {

// The only cell, in millimetres from a metre on: 0, 1, 2, … 15, in row-major order. The middle
// pixel is number 10.
cv::Mat cell() {
  cv::Mat depth(kCell, kCell, CV_32F);
  for (int i = 0; i < kCell * kCell; ++i)
    depth.at<float>(i / kCell, i % kCell) = 1 + 0.001F * static_cast<float>(i);
  return depth;
}

float sampled(const cv::Mat& depth) { return sample_depth(depth).at<float>(0, 0); }

TEST(SampleDepth, IsThatOfTheMiddlePixel) {
  cv::Mat depth = cell();
  EXPECT_FLOAT_EQ(sampled(depth), 1.010F);
  depth(cv::Rect(0, 0, kCell, kCell / 2)).setTo(0);  // whatever is missing beside it
  EXPECT_FLOAT_EQ(sampled(depth), 1.010F);
}

TEST(SampleDepth, IsTheMedianWhereTheMiddlePixelIsMissing) {
  cv::Mat depth = cell();
  depth.at<float>(kCellMiddle, kCellMiddle) = 0;
  EXPECT_FLOAT_EQ(sampled(depth), 1.007F);  // of 0 to 15 without 10
}

TEST(SampleDepth, IsNoneWhereMostOfTheCellIsMissing) {
  cv::Mat depth = cell();
  depth(cv::Rect(0, kCellMiddle, kCell, kCell / 2)).setTo(0);
  EXPECT_FLOAT_EQ(sampled(depth), 1.004F);  // of 0 to 7
  depth.at<float>(0, 0) = 0;
  EXPECT_EQ(sampled(depth), 0);
}

TEST(SampleDepth, IsNoneWhereTheMiddlePixelIsMissingBesideADepthEdge) {
  cv::Mat depth = cell();
  depth.at<float>(kCellMiddle, kCellMiddle) = 0;
  depth.col(0).setTo(1.1F);
  EXPECT_EQ(sampled(depth), 0);
}

}  // namespace
}  // namespace stillpoint::map_checks
