#include "stillpoint/support/exposure.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

TEST(LevelQuantile, CountsTheValuesOfAllChannels) {
  cv::Mat ramp(10, 10, CV_8UC3);  // levels 0, 2, 4 … 198, in blue; the other channels are black
  for (int i = 0; i < 100; ++i)
    ramp.at<cv::Vec3b>(i / 10, i % 10) = cv::Vec3b(static_cast<std::uint8_t>(2 * i), 0, 0);
  EXPECT_EQ(level_quantile(ramp, 0.5), 0);
  EXPECT_EQ(level_quantile(ramp, 0.99), 192);  // three of 300 values are larger
  EXPECT_EQ(level_quantile(ramp, 1.0), 198);
}

TEST(LevelQuantile, OfExtremes) {
  EXPECT_EQ(level_quantile(cv::Mat(3, 4, CV_8UC1, cv::Scalar(255)), 0.99), 255);
  EXPECT_EQ(level_quantile(cv::Mat(3, 4, CV_8UC1, cv::Scalar(0)), 0.99), 0);
  EXPECT_EQ(level_quantile(cv::Mat(), 0.99), 0);
  EXPECT_THROW(level_quantile(cv::Mat(3, 4, CV_16UC1, cv::Scalar(7)), 0.99), Error);
}

TEST(LevelQuantile, OfAPartOfAnImage) {
  cv::Mat image(8, 8, CV_8UC1, cv::Scalar(200));
  image(cv::Rect(2, 2, 3, 3)).setTo(40);
  EXPECT_EQ(level_quantile(image(cv::Rect(2, 2, 3, 3)), 0.99), 40);
}

}  // namespace
}  // namespace stillpoint
