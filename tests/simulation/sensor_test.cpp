#include "simulation/sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "simulation/simulator.hpp"

namespace stillpoint::simulation {
namespace {

View wall(float depth) {
  const cv::Size size(320, 240);
  return {.color = cv::Mat(size, CV_32FC3, cv::Scalar(128, 128, 128)),
          .depth = cv::Mat(size, CV_32F, cv::Scalar(depth)),
          .infrared = cv::Mat(size, CV_32F, cv::Scalar(1)),
          .labels = cv::Mat::zeros(size, CV_8U),
          .instances = cv::Mat::zeros(size, CV_8U)};
}

/// Standard deviation of the depth of a flat wall, metres, without quantisation.
double depth_sigma(float depth) {
  SensorOptions options;
  options.disparity_step = 0;
  const cv::Mat image = Sensor(options, 1, 50000, 1).depth_image(wall(depth), 0);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image, mean, deviation, image > 0);
  EXPECT_NEAR(mean[0] / 50000, depth, 0.01 * depth);
  return deviation[0] / 50000;
}

TEST(Sensor, DepthNoiseGrowsWithTheSquareOfTheDistance) {
  const double near = depth_sigma(0.6F);
  EXPECT_NEAR(near, 0.055 / 43.5 * 0.36, 0.25 * near);
  EXPECT_NEAR(depth_sigma(1.2F) / near, 4, 0.4);
}

// What stages assume of the simulated camera is what it does, with quantisation.
TEST(Sensor, ItsNoiseIsThatOfItsCamera) {
  const double stated = default_camera().surface_noise;
  for (const float depth : {0.9F, 1.7F, 3.1F}) {
    const cv::Mat image = Sensor({}, 1, 10000, 1).depth_image(wall(depth), 0);
    cv::Scalar mean, deviation;
    cv::meanStdDev(image, mean, deviation, image > 0);
    EXPECT_NEAR(deviation[0] / 10000 / (depth * depth), stated, 0.25 * stated) << depth;
  }
}

TEST(Sensor, DisparityComesInSteps) {
  SensorOptions options;
  const cv::Mat image = Sensor(options, 1, 5000, 1).depth_image(wall(3.0F), 0);
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(image)) {
    if (value == 0) continue;
    const double steps = options.baseline_focal / (value / 5000.0) / options.disparity_step;
    ASSERT_NEAR(steps, std::round(steps), 0.02);
  }
}

TEST(Sensor, ShadowLiesLeftOfANearSurface) {
  View view = wall(3.0F);
  view.depth(cv::Rect(160, 0, 60, 240)).setTo(1.0F);
  const cv::Mat image = Sensor({}, 1, 5000, 1).depth_image(view, 0);
  // The width of the shadow is the difference of disparities: 43.5 (1/1 - 1/3) = 29 px.
  EXPECT_EQ(cv::countNonZero(image(cv::Rect(134, 0, 24, 240))), 0);
  EXPECT_EQ(cv::countNonZero(image(cv::Rect(225, 0, 80, 240))), 80 * 240);
  EXPECT_EQ(cv::countNonZero(image(cv::Rect(20, 0, 100, 240))), 100 * 240);
}

TEST(Sensor, MeasuresWithinItsRangeAndWhatReflectsOnly) {
  const Sensor sensor({}, 1, 5000, 1);
  EXPECT_EQ(cv::countNonZero(sensor.depth_image(wall(0.3F), 0)), 0);
  EXPECT_EQ(cv::countNonZero(sensor.depth_image(wall(7.0F), 0)), 0);
  View dark = wall(2.0F);
  dark.infrared.setTo(0.01F);
  EXPECT_EQ(cv::countNonZero(sensor.depth_image(dark, 0)), 0);
}

TEST(Sensor, ColorNoiseHasItsStandardDeviation) {
  SensorOptions options;
  options.color_noise = 3;
  options.exposure_drift = 0;
  const cv::Mat image = Sensor(options, 1, 5000, 1).color_image(wall(2), 0, 0);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image(cv::Rect(130, 90, 60, 60)), mean, deviation);
  EXPECT_NEAR(mean[0], 128, 1);
  EXPECT_NEAR(deviation[1], 3, 0.3);
}

}  // namespace
}  // namespace stillpoint::simulation
