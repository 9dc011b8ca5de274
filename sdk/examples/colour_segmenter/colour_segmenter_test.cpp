#include "colour_segmenter.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stillpoint/testing/test_recording.hpp>

namespace {

const cv::Scalar kRed(0, 0, 200), kBlue(200, 30, 0), kWhite(255, 255, 255);

/// A frame of a room, whose own colours are dull, for tests to paint into.
stillpoint::Frame room() {
  static const stillpoint::testing::TestRecording recording({.frames = 1, .person = false});
  stillpoint::Frame frame = *recording.frame(0);
  frame.bgr = frame.bgr.clone();  // images are shared
  return frame;
}

TEST(ColourSegmenter, TellsClassesApart) {
  const cv::Rect trolley(40, 60, 60, 50), vest(200, 80, 40, 60);
  stillpoint::Frame frame = room();
  cv::rectangle(frame.bgr, trolley, kBlue, cv::FILLED);
  cv::rectangle(frame.bgr, vest, kRed, cv::FILLED);
  ColourSegmenter segmenter({.classes = {{.name = "vest", .hue = {350, 10}},  // across red
                                         {.name = "trolley", .hue = {220, 250}}}});
  const auto objects = segmenter.segment(frame).objects;
  EXPECT_EQ(segmenter.classes(), (stillpoint::ClassNames{"background", "vest", "trolley"}));
  ASSERT_EQ(objects.size(), 2u);  // the largest first
  EXPECT_EQ(objects[0].label, 2);
  EXPECT_EQ(objects[0].box, trolley);
  EXPECT_EQ(objects[1].label, 1);
  EXPECT_EQ(objects[1].box, vest);
}

TEST(ColourSegmenter, AVestWithAReflectingStripeIsOneObject) {
  const cv::Rect vest(100, 60, 40, 60);
  stillpoint::Frame frame = room();
  cv::rectangle(frame.bgr, vest, kRed, cv::FILLED);
  cv::rectangle(frame.bgr, cv::Rect(100, 85, 40, 6), kWhite, cv::FILLED);
  ColourSegmenter segmenter({.classes = {{.name = "vest", .hue = {350, 10}}}, .gap = 4});
  const auto objects = segmenter.segment(frame).objects;
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].box, vest);
}

}  // namespace
