#include "inspection/time_offset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

namespace stillpoint::inspection {
namespace {

using ::testing::HasSubstr;

constexpr double kRate = 30.0;  // Hz

cv::Mat wallpaper() {
  cv::Mat noise(400, 500, CV_8UC3), smooth;
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(noise, smooth, {0, 0}, 4);
  return smooth * 2 - cv::Scalar::all(128);
}

/// Boxes before a wall at 4 m, with the holes that a depth camera leaves.
cv::Mat relief() {
  cv::Mat depth(400, 500, CV_16UC1, cv::Scalar(20000));
  cv::RNG rng(5);
  for (int i = 0; i < 40; ++i) {
    const cv::Rect box(rng.uniform(0, 450), rng.uniform(0, 350), rng.uniform(20, 80),
                       rng.uniform(20, 80));
    depth(box & cv::Rect(0, 0, 500, 400)) = i % 5 == 0 ? 0 : rng.uniform(4000, 15000);
  }
  return depth;
}

cv::Mat view(const cv::Mat& world, cv::Point2d corner, int interpolation) {
  const cv::Matx23d shift(1, 0, -corner.x, 0, 1, -corner.y);
  cv::Mat image;
  cv::warpAffine(world, image, shift, {320, 240}, interpolation);
  return image;
}

using Path = std::function<cv::Point2d(double)>;

/// A hand-held camera: two frequencies on each axis.
cv::Point2d wobble(double t) {
  return {80 + 40 * std::sin(4.1 * t) + 9 * std::sin(11 * t),
          70 + 30 * std::cos(3.3 * t) + 8 * std::sin(9 * t + 1)};
}

/// Depth images show what was there `offset` seconds after the time on their stamp.
std::vector<MotionStretch> record(const Path& color, const Path& depth, double offset) {
  const cv::Mat colors = wallpaper(), depths = relief();
  std::vector<MotionStretch> stretches(4);
  for (int s = 0; s < 4; ++s)
    for (int i = 0; i < 30; ++i) {
      const double time = 10.0 * s + i / kRate;
      const double depth_stamp = time + 0.007;
      stretches[s].color.add_color(time, view(colors, color(time), cv::INTER_LINEAR));
      stretches[s].depth.add_depth(depth_stamp,
                                   view(depths, depth(depth_stamp + offset), cv::INTER_NEAREST));
    }
  return stretches;
}

TEST(TimeOffset, IsFoundFromTheMotion) {
  for (const double offset : {-0.060, -0.033, 0.0, 0.015}) {
    const TimeOffset estimate = estimate_time_offset(record(wobble, wobble, offset));
    ASSERT_TRUE(estimate.known) << estimate.reason;
    EXPECT_NEAR(estimate.offset, offset, 0.004);
    EXPECT_LT(estimate.deviation, 0.006);
    EXPECT_GT(estimate.correlation, 0.8);
  }
}

TEST(TimeOffset, CannotBeToldOfACameraAtRest) {
  const Path rest = [](double) { return cv::Point2d(50, 50); };
  const TimeOffset estimate = estimate_time_offset(record(rest, rest, 0.02));
  EXPECT_FALSE(estimate.known);
  EXPECT_THAT(estimate.reason, HasSubstr("hardly moves"));
}

// It looks alike at all offsets, and noise would decide.
TEST(TimeOffset, CannotBeToldOfSteadyMotion) {
  const Path steady = [](double t) {
    const double seconds = std::fmod(t, 10.0);  // of the stretch
    return cv::Point2d(20 + 90 * seconds + 0.5 * std::sin(9 * t), 50);
  };
  for (const double offset : {0.0, 0.06}) {
    const TimeOffset estimate = estimate_time_offset(record(steady, steady, offset));
    EXPECT_FALSE(estimate.known) << estimate.offset;
    EXPECT_THAT(estimate.reason, HasSubstr("steadily"));
  }
}

TEST(TimeOffset, CannotBeToldOfUnrelatedMotion) {
  const Path other = [](double t) { return wobble(1.7 * t + 5); };
  const TimeOffset estimate = estimate_time_offset(record(wobble, other, 0.0));
  EXPECT_FALSE(estimate.known);
  EXPECT_FALSE(estimate.reason.empty());
}

TEST(TimeOffset, CannotBeToldOfNothing) {
  EXPECT_FALSE(estimate_time_offset({}).known);
  EXPECT_FALSE(estimate_time_offset(std::vector<MotionStretch>(3)).known);
}

}  // namespace
}  // namespace stillpoint::inspection
