#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stillpoint/testing/test_recording.hpp>

namespace plugins::my_plugin {
namespace {

stillpoint::StageContext context() { return stillpoint::testing::test_context(); }

TEST(MyPlugin, GivesEveryFrameInOrderAndThenNothing) {
  MyPlugin source({.frames = 3}, context());
  EXPECT_EQ(source.size(), 3u);
  double last = -1;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_GT(frame->time, last);
    last = frame->time;
    const cv::Size size(frame->camera->width, frame->camera->height);
    EXPECT_EQ(frame->bgr.size(), size);
    EXPECT_EQ(frame->gray.size(), size);
    EXPECT_EQ(frame->depth.size(), size);
    EXPECT_EQ(frame->depth.at<float>(7, 9), 2.0f);
  }
  EXPECT_FALSE(source.next());
  EXPECT_FALSE(source.next());
}

TEST(MyPlugin, TheImageMovesByTheSpeedOfTheCamera) {
  // 1/30 s at this speed is exactly 10 px.
  const double speed = 10 * 30 * 2.0 / 262.5;
  MyPlugin source({.frames = 2, .speed = speed}, context());
  const cv::Mat before = source.next()->gray, after = source.next()->gray;
  const cv::Mat moved = before.colRange(10, before.cols), here = after.colRange(0, after.cols - 10);
  EXPECT_LT(cv::norm(moved, here, cv::NORM_INF), 10);
  EXPECT_GT(cv::norm(before, after, cv::NORM_INF), 50);
}

TEST(MyPlugin, HasTheCameraOfThePipelineFile) {
  stillpoint::StageContext with_camera = context();
  with_camera.camera = stillpoint::CameraModel{.width = 64, .height = 48, .fx = 60, .fy = 60};
  const auto frame = MyPlugin({}, with_camera).next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->bgr.size(), cv::Size(64, 48));
  EXPECT_EQ(frame->camera->fx, 60);
}

}  // namespace
}  // namespace plugins::my_plugin
