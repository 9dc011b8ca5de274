#include "people/depth_sensor.hpp"

#include <gtest/gtest.h>

namespace stillpoint::people {
namespace {

const cv::Size kSize(200, 150);
const cv::Rect kBox(90, 20, 80, 100);

cv::Mat pasted(double z) {
  cv::Mat result = cv::Mat::zeros(kSize, CV_32F);
  result(kBox).setTo(z);
  return result;
}

cv::Mat measured(double z, double scene, std::uint32_t frame = 0) {
  cv::Mat depth(kSize, CV_32F, cv::Scalar(scene));
  measure(pasted(z), 1, frame, depth);
  return depth;
}

TEST(DepthSensor, ErrorsGrowWithTheSquareOfTheDistance) {
  const auto deviation = [](double z) {
    const cv::Rect inner(kBox.tl() + cv::Point(2, 2), kBox.br() - cv::Point(2, 2));
    cv::Scalar mean, sigma;
    cv::meanStdDev(measured(z, 8)(inner), mean, sigma);
    EXPECT_NEAR(mean[0], z, 0.002 * z * z);
    return sigma[0];
  };
  EXPECT_NEAR(deviation(1.5), 0.0015 * 1.5 * 1.5, 0.0007);
  EXPECT_NEAR(deviation(3) / deviation(1.5), 4, 1);
}

TEST(DepthSensor, TheSceneLeftOfSomethingNearIsInShadow) {
  const cv::Mat depth = measured(1, 4);
  const double shadow = 43.5 * (1 - 1.0 / 4);  // px
  EXPECT_EQ(cv::countNonZero(depth(cv::Rect(kBox.x - 30, 60, 30, 1))), 0);
  EXPECT_EQ(depth.at<float>(60, kBox.x - static_cast<int>(shadow) - 3), 4);
  EXPECT_EQ(depth.at<float>(60, kBox.br().x + 1), 4);
  EXPECT_EQ(depth.at<float>(5, kBox.x), 4);
}

TEST(DepthSensor, WhatIsTooNearIsNotMeasured) {
  EXPECT_EQ(cv::countNonZero(measured(0.35, 4)(kBox)), 0);
}

}  // namespace
}  // namespace stillpoint::people
