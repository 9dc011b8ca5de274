#include "orb_slam/orb_descriptor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "orb_slam/orb_pattern.hpp"

namespace stillpoint::orb_slam {
namespace {

cv::Mat random_image(int width, int height) {
  cv::Mat image(height, width, CV_8UC1);
  cv::RNG random(11);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

double radians(const Direction& d) { return std::atan2(d.sine, d.cosine); }

TEST(PatchDirection, PointsToTheIntensityCentroid) {
  const cv::Mat image = random_image(39, 41);
  for (int x = 19; x < 20; ++x) {
    for (int y = 19; y < 22; ++y) {
      double m10 = 0, m01 = 0;
      for (int v = -15; v <= 15; ++v)
        for (int u = -15; u <= 15; ++u)
          if (std::hypot(u, v) < 15.5) {
            m10 += u * image.at<uchar>(y + v, x + u);
            m01 += v * image.at<uchar>(y + v, x + u);
          }
      const Direction direction = patch_direction(image, x, y);
      const double length = std::hypot(m10, m01);
      EXPECT_NEAR(direction.cosine, Direction::kOne * m10 / length, 0.51);
      EXPECT_NEAR(direction.sine, Direction::kOne * m01 / length, 0.51);
    }
  }
}

TEST(PatchDirection, HoldsTheLargestMoments) {
  cv::Mat image(39, 39, CV_8UC1, cv::Scalar(0));
  image.rowRange(20, 39) = 255;
  EXPECT_EQ(patch_direction(image, 19, 19).sine, Direction::kOne);
  image = image.t();
  EXPECT_EQ(patch_direction(image, 19, 19).cosine, Direction::kOne);
}

TEST(PatchDirection, IsAlongXInAFlatDisc) {
  const Direction direction = patch_direction(cv::Mat(39, 39, CV_8UC1, cv::Scalar(255)), 19, 19);
  EXPECT_EQ(direction.cosine, Direction::kOne);
  EXPECT_EQ(direction.sine, 0);
}

TEST(AngleDegrees, IsTheAngleOfTheDirection) {
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const Direction direction{static_cast<int>(std::lround(1024 * std::cos(angle))),
                              static_cast<int>(std::lround(1024 * std::sin(angle)))};
    double expected = radians(direction) * 180 / std::numbers::pi;
    if (expected < 0) expected += 360;
    EXPECT_NEAR(angle_degrees(direction), expected, 0.001);
    EXPECT_LT(angle_degrees(direction), 360);
  }
}

TEST(OrbDescriptor, ComparesTheRotatedPoints) {
  const cv::Mat image = random_image(39, 39);
  for (int degrees = 0; degrees < 360; degrees += 13) {
    const double angle = degrees * std::numbers::pi / 180;
    const Direction direction{static_cast<int>(std::lround(1024 * std::cos(angle))),
                              static_cast<int>(std::lround(1024 * std::sin(angle)))};
    const double c = direction.cosine / 1024.0, s = direction.sine / 1024.0;
    const auto value = [&](int x, int y) {
      return image.at<uchar>(19 + static_cast<int>(std::floor(x * s + y * c + 0.5)),
                             19 + static_cast<int>(std::floor(x * c - y * s + 0.5)));
    };
    const Descriptor descriptor = orb_descriptor(image, 19, 19, direction);
    for (std::size_t i = 0; i < 256; ++i) {
      const BinaryTest& test = kOrbPattern[i];
      EXPECT_EQ((descriptor[i / 64] >> (i % 64)) & 1,
                value(test.x1, test.y1) < value(test.x2, test.y2));
    }
  }
}

TEST(OrbDescriptor, TurnsWithTheImage) {
  cv::Mat image = random_image(201, 201), turned;
  cv::GaussianBlur(image, image, {}, 4);
  cv::normalize(image, image, 0, 255, cv::NORM_MINMAX);
  const Descriptor before = orb_descriptor(image, 100, 100, patch_direction(image, 100, 100));
  for (int degrees = 0; degrees < 360; degrees += 30) {
    const cv::Mat rotation = cv::getRotationMatrix2D({100, 100}, degrees, 1);
    cv::warpAffine(image, turned, rotation, image.size());
    const Direction direction = patch_direction(turned, 100, 100);
    EXPECT_LT(hamming_distance(before, orb_descriptor(turned, 100, 100, direction)), 40) << degrees;
  }
}

}  // namespace
}  // namespace stillpoint::orb_slam
