#include "stillpoint/testing/test_recording.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace stillpoint::testing {
namespace {

// What frame i shows where points of frame i - 1 should be, when they are followed by the truth.
double mean_grey_difference(const TestRecording& recording, std::size_t i) {
  double sum = 0;
  const MovingPoints moving = recording.moving_points(i);
  for (const PointMotion& point : moving.points) {
    cv::Mat before, now;
    cv::getRectSubPix(recording.frame(i - 1)->gray, {1, 1}, point.previous, before);
    cv::getRectSubPix(recording.frame(i)->gray, {1, 1}, point.current, now);
    sum += std::abs(before.at<std::uint8_t>(0) - now.at<std::uint8_t>(0));
  }
  return sum / static_cast<double>(moving.points.size());
}

TEST(TestRecording, ImagesDepthAndMotionsBelongTogether) {
  const TestRecording recording({.frames = 8});
  ASSERT_EQ(recording.size(), 8U);
  EXPECT_TRUE(recording.moving_points(0).points.empty());
  for (std::size_t i = 1; i < recording.size(); ++i) {
    const MovingPoints moving = recording.moving_points(i);
    EXPECT_GT(moving.points.size(), 200U);
    EXPECT_LT(mean_grey_difference(recording, i), 8);  // of neighbouring pixels: about 20
    int on_person = 0;
    for (const PointMotion& point : moving.points) {
      EXPECT_EQ(point.moving, point.residual > 1e-3) << point.residual;
      on_person += point.moving;
    }
    EXPECT_GT(on_person, 20);
  }
}

TEST(TestRecording, IsTheSameForOneSeed) {
  const TestRecordingOptions options{.frames = 2, .depth_noise = 0.002, .seed = 5};
  const TestRecording one(options), other(options);
  EXPECT_EQ(cv::norm(one.frame(1)->bgr, other.frame(1)->bgr), 0);
  EXPECT_EQ(cv::norm(one.frame(1)->depth, other.frame(1)->depth), 0);
  const TestRecording third({.frames = 2, .depth_noise = 0.002, .seed = 6});
  EXPECT_GT(cv::norm(one.frame(1)->bgr, third.frame(1)->bgr), 0);
  EXPECT_GT(cv::norm(one.frame(1)->depth, third.frame(1)->depth), 0);
}

TEST(TestRecording, HasWhatStagesNeed) {
  const TestRecording recording(
      {.frames = 2, .width = 161, .height = 121, .first_index = 40, .depth_noise = 0});
  const FramePtr frame = recording.frame(1);
  EXPECT_EQ(frame->index, 41U);
  EXPECT_EQ(frame->gray.size(), cv::Size(161, 121));
  EXPECT_EQ(recording.segmentation(1)->frame, 41U);
  ASSERT_EQ(recording.segmentation(1)->objects.size(), 1U);
  EXPECT_EQ(recording.weights(1)->object_moves.size(), 1U);
  EXPECT_EQ(cv::countNonZero(recording.weights(1)->track == 0),
            cv::countNonZero(recording.segmentation(1)->labels));

  const KeyFrame keyframe = recording.keyframe(1, 7);
  EXPECT_EQ(keyframe.id, 7U);
  EXPECT_GT(keyframe.features->size(), 100U);
  EXPECT_EQ(keyframe.features->descriptors.size(), keyframe.features->size());
  EXPECT_EQ(keyframe.track_weights.size(), keyframe.features->size());
  EXPECT_EQ(keyframe.landmarks.size(), keyframe.features->size());

  const TestRecording alone({.frames = 1, .person = false});
  EXPECT_TRUE(alone.segmentation(0)->objects.empty());
}

}  // namespace
}  // namespace stillpoint::testing
