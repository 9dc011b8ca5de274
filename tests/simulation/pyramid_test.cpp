#include "simulation/pyramid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <thread>
#include <vector>

namespace stillpoint::simulation {
namespace {

cv::Mat random_picture(cv::Size size) {
  cv::Mat picture(size, CV_8UC3);
  cv::RNG(7).fill(picture, cv::RNG::UNIFORM, 0, 256);
  return picture;
}

double mean_blue(const PyramidLevel& level) {
  double sum = 0;
  for (const std::uint32_t texel : level.texels) sum += texel & 255;
  return sum / static_cast<double>(level.texels.size());
}

TEST(Pyramid, BeginsWithThePicture) {
  const cv::Mat picture = random_picture({64, 16});
  const Pyramid pyramid(picture, {2.0F, 0.5F});
  const PyramidLevel& finest = pyramid.level(0);
  ASSERT_EQ(cv::Size(finest.width, finest.height), picture.size());
  EXPECT_EQ(finest.from_uv, Eigen::Vector2f(256 * 32, 256 * 32));
  const auto& color = picture.at<cv::Vec3b>(3, 5);
  EXPECT_EQ(finest.texels[3 * 64 + 5],
            static_cast<std::uint32_t>(color[0] | color[1] << 8 | color[2] << 16));
}

TEST(Pyramid, EndsWithItsMean) {
  const cv::Mat picture = random_picture({64, 16});
  const Pyramid pyramid(picture, {2.0F, 0.5F});
  ASSERT_EQ(pyramid.level_count(), 13);  // widths of 64, 32, … 1, and between them
  const PyramidLevel& coarsest = pyramid.level(12);
  EXPECT_EQ(coarsest.texels.size(), 1U);
  EXPECT_NEAR(mean_blue(coarsest), cv::mean(picture)[0], 2);  // rounded seven times
}

TEST(Pyramid, HalfAnOctaveIsCoarserAndNotSmaller) {
  const Pyramid pyramid(random_picture({64, 64}), {1.0F, 1.0F});
  const auto& fine = pyramid.level(0);
  const auto& half = pyramid.level(1);
  ASSERT_EQ(half.texels.size(), fine.texels.size());
  const auto contrast = [](const PyramidLevel& level) {
    const double mean = mean_blue(level);
    double sum = 0;
    for (const std::uint32_t texel : level.texels) sum += std::pow((texel & 255) - mean, 2);
    return std::sqrt(sum / static_cast<double>(level.texels.size()));
  };
  // Of noise: the kernel (1, 6, 1) / 8 along both sides keeps 38 / 64 of the standard deviation.
  EXPECT_NEAR(contrast(half) / contrast(fine), 38.0 / 64, 0.03);
}

TEST(Pyramid, SidesBecomePowersOfTwo) {
  const Pyramid pyramid(random_picture({100, 33}), {1.0F, 1.0F});
  EXPECT_EQ(pyramid.finest(), cv::Size(128, 64));
  EXPECT_EQ(pyramid.level(0).width, 128);
  EXPECT_EQ(pyramid.level(6).height, 8);
}

TEST(Pyramid, ManyThreadsGetTheSameLevelsInAnyOrder) {
  const cv::Mat picture = random_picture({256, 256});
  const Pyramid one(picture, {1.0F, 1.0F}), other(picture, {1.0F, 1.0F});
  std::vector<std::vector<const PyramidLevel*>> seen(4);
  {
    std::vector<std::jthread> threads;
    for (auto& levels : seen)
      threads.emplace_back([&] {
        for (int i = 0; i < one.level_count(); ++i) levels.push_back(&one.level(i));
      });
  }
  for (const auto& levels : seen) EXPECT_EQ(levels, seen.front());
  for (int i = other.level_count() - 1; i >= 0; --i)
    EXPECT_EQ(other.level(i).texels, one.level(i).texels) << i;
}

}  // namespace
}  // namespace stillpoint::simulation
