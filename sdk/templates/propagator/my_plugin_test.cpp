#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stillpoint/testing/test_recording.hpp>

namespace plugins::my_plugin {
namespace {

using stillpoint::testing::TestRecording;

const TestRecording& recording() {
  static const TestRecording recording({.frames = 4});
  return recording;
}

/// Intersection over union of the people in two label images.
double overlap(const cv::Mat& a, const cv::Mat& b) {
  const cv::Mat both = (a != 0) & (b != 0), any = (a != 0) | (b != 0);
  return static_cast<double>(cv::countNonZero(both)) / cv::countNonZero(any);
}

TEST(MyPlugin, LabelsFollowThePerson) {
  MyPlugin propagator(MyPlugin::Options{});
  const auto before = recording().segmentation(0), truth = recording().segmentation(3);
  const auto result = propagator.propagate(*before, *recording().frame(0), *recording().frame(3));
  EXPECT_EQ(result.frame, 3u);
  EXPECT_GT(overlap(result.labels, truth->labels), 0.9);
  EXPECT_GT(overlap(result.labels, truth->labels), overlap(before->labels, truth->labels));
  ASSERT_EQ(result.objects.size(), before->objects.size());
  EXPECT_EQ(result.objects[0].pixels, cv::countNonZero(result.instances == 1));
}

TEST(MyPlugin, ObjectsAreFoundWhereTheyAreNotGiven) {
  stillpoint::Segmentation labels = *recording().segmentation(0);
  labels.instances = cv::Mat();
  labels.objects.clear();
  const auto result =
      MyPlugin(MyPlugin::Options{}).propagate(labels, *recording().frame(0), *recording().frame(3));
  EXPECT_GT(overlap(result.labels, recording().segmentation(3)->labels), 0.9);
}

TEST(MyPlugin, NothingKnownStaysNothing) {
  const auto result =
      MyPlugin(MyPlugin::Options{}).propagate({}, *recording().frame(0), *recording().frame(1));
  EXPECT_FALSE(result.known());
}

TEST(MyPlugin, WithoutTextureLabelsStay) {
  stillpoint::Frame black = *recording().frame(1);
  black.gray = cv::Mat(black.gray.size(), CV_8UC1, cv::Scalar(0));
  stillpoint::Frame earlier = black;
  earlier.index = 0;
  const auto before = recording().segmentation(0);
  const auto result = MyPlugin(MyPlugin::Options{}).propagate(*before, earlier, black);
  EXPECT_EQ(overlap(result.labels, before->labels), 1.0);
}

}  // namespace
}  // namespace plugins::my_plugin
