#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stillpoint/testing/test_recording.hpp>

namespace plugins::my_plugin {
namespace {

const cv::Rect kThing(100, 60, 40, 50);
const cv::Scalar kYellow(0, 200, 150), kRed(0, 0, 200);

/// A frame of a room, in which one rectangle has the colour.
stillpoint::Frame frame_with(const cv::Scalar& colour) {
  const stillpoint::testing::TestRecording recording({.frames = 1, .person = false});
  stillpoint::Frame frame = *recording.frame(0);
  frame.bgr = frame.bgr.clone();  // images are shared
  cv::rectangle(frame.bgr, kThing, colour, cv::FILLED);
  return frame;
}

TEST(MyPlugin, LabelsWhatHasTheColour) {
  MyPlugin segmenter(MyPlugin::Options{});
  const auto result = segmenter.segment(frame_with(kYellow));
  EXPECT_EQ(segmenter.classes(), (stillpoint::ClassNames{"background", "person"}));
  ASSERT_EQ(result.objects.size(), 1u);
  EXPECT_EQ(result.objects[0].label, 1);
  EXPECT_EQ(result.objects[0].box, kThing);
  EXPECT_EQ(cv::countNonZero(result.labels), kThing.area());
}

TEST(MyPlugin, HuesCanGoAcrossRed) {
  MyPlugin segmenter({.min_hue = 340, .max_hue = 20, .min_saturation = 200});
  const auto result = segmenter.segment(frame_with(kRed));
  ASSERT_EQ(result.objects.size(), 1u);
  EXPECT_EQ(result.objects[0].box, kThing);
  EXPECT_TRUE(segmenter.segment(frame_with(kYellow)).objects.empty());
}

TEST(MyPlugin, WithoutTheColourAllIsBackground) {
  stillpoint::Frame frame = frame_with(kYellow);
  frame.bgr = cv::Mat(frame.bgr.size(), CV_8UC3, cv::Scalar(0));
  const auto result = MyPlugin(MyPlugin::Options{}).segment(frame);
  EXPECT_TRUE(result.known());
  EXPECT_EQ(cv::countNonZero(result.labels), 0);
}

}  // namespace
}  // namespace plugins::my_plugin
