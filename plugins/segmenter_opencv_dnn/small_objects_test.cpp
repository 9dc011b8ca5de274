#include "segmenter_opencv_dnn/small_objects.hpp"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "stillpoint/support/objects.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

constexpr double kNear = 1.0, kFar = 3.0;  // m

/// Two parts of one class, each of 20 x 30 pixels, of which 10,000 make a square metre at 1 m: 0.06
/// m² at 1 m, 0.54 m² at 3 m. The left one is near.
struct TwoParts : ::testing::Test {
  TwoParts() {
    auto camera = std::make_shared<Camera>();
    camera->fx = 50;
    camera->fy = 200;
    frame.camera = camera;
    frame.depth = cv::Mat(60, 80, CV_32FC1, cv::Scalar(kFar));
    frame.depth(left).setTo(kNear);
    segmentation.labels = cv::Mat(60, 80, CV_8UC1, cv::Scalar(0));
    for (const cv::Rect& part : {left, right}) segmentation.labels(part).setTo(1);
    find_objects(segmentation, 1);
  }

  const cv::Rect left{5, 10, 20, 30}, right{50, 10, 20, 30};
  Frame frame;
  Segmentation segmentation;
};

TEST_F(TwoParts, AreaIsThatOfTheSurface) {
  const std::size_t near = segmentation.objects[0].box == left ? 0 : 1;
  EXPECT_NEAR(*visible_area(segmentation, near, frame), 0.06, 1e-9);
  EXPECT_NEAR(*visible_area(segmentation, 1 - near, frame), 0.54, 1e-9);
}

TEST_F(TwoParts, WhatIsSmallBecomesBackground) {
  remove_small_objects(segmentation, frame, {.pixels = 1, .area = 0.07});
  ASSERT_EQ(segmentation.objects.size(), 1u);
  EXPECT_EQ(segmentation.objects[0].box, right);
  EXPECT_EQ(cv::countNonZero(segmentation.labels), right.area());
  EXPECT_EQ(cv::countNonZero(segmentation.labels(right)), right.area());
  EXPECT_EQ(cv::countNonZero(segmentation.instances == 1), right.area());
}

TEST_F(TwoParts, WhoIsNotCertainMustBeLarger) {
  for (SegmentedObject& object : segmentation.objects) object.score = 0.75F;
  remove_small_objects(segmentation, frame, {.pixels = 1, .area = 0.05});
  ASSERT_EQ(segmentation.objects.size(), 1u);
  EXPECT_EQ(segmentation.objects[0].box, right);
  remove_small_objects(segmentation, frame, {.pixels = 1, .area = 0.4});
  EXPECT_EQ(segmentation.objects.size(), 1u);  // 0.54 m² of 0.75
}

TEST_F(TwoParts, PixelsWithoutDepthAreAsFarAsTheOthers) {
  frame.depth(cv::Rect(left.tl(), cv::Size(20, 20))).setTo(0);
  remove_small_objects(segmentation, frame, {.pixels = 1, .area = 0.05});
  EXPECT_EQ(segmentation.objects.size(), 2u);
  remove_small_objects(segmentation, frame, {.pixels = 1, .area = 0.07});
  EXPECT_EQ(segmentation.objects.size(), 1u);
}

TEST_F(TwoParts, WhoseAreaIsUnknownStays) {
  frame.depth(cv::Rect(left.tl(), cv::Size(20, 25))).setTo(0);
  remove_small_objects(segmentation, frame, {.pixels = 1, .area = 0.3});
  EXPECT_EQ(segmentation.objects.size(), 2u);
  frame.depth.release();
  remove_small_objects(segmentation, frame, {.pixels = 1, .area = 100});
  EXPECT_EQ(segmentation.objects.size(), 2u);
}

TEST_F(TwoParts, PixelsCountToo) {
  remove_small_objects(segmentation, frame, {.pixels = 601});
  EXPECT_TRUE(segmentation.objects.empty());
  EXPECT_EQ(cv::countNonZero(segmentation.labels), 0);
  EXPECT_EQ(cv::countNonZero(segmentation.instances), 0);
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
