#include "segmenter_opencv_dnn/box_mask.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

constexpr float kWall = 4.0f;     // metres
constexpr float kPerson = 2.0f;   // metres
constexpr double kNoise = 0.002;  // metres at 1 m
const cv::Rect kBox(80, 40, 80, 160);

/// A person (head and body) before a wall; returns the person's mask.
cv::Mat draw_person(cv::Mat& depth, cv::Point feet) {
  cv::Mat person(depth.size(), CV_8UC1, cv::Scalar(0));
  cv::rectangle(person, cv::Rect(feet.x - 25, feet.y - 110, 50, 110), cv::Scalar(255), cv::FILLED);
  cv::circle(person, {feet.x, feet.y - 125}, 16, cv::Scalar(255), cv::FILLED);
  depth.setTo(kPerson, person);
  return person;
}

double intersection_over_union(const cv::Mat& a, const cv::Mat& b) {
  return static_cast<double>(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}

TEST(BoxMask, IsTheNearSurface) {
  cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(kWall));
  const cv::Mat person = draw_person(depth, {120, 190});
  const cv::Mat found = box_mask(depth, kNoise, kBox, {});
  EXPECT_EQ(cv::countNonZero(found != person(kBox)), 0);
}

TEST(BoxMask, NoiseAndSmallGapsDoNotMatter) {
  cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(kWall));
  const cv::Mat person = draw_person(depth, {120, 190});
  cv::Mat noise(depth.size(), CV_32FC1);
  cv::RNG(3).fill(noise, cv::RNG::NORMAL, 0.0, 0.008);
  depth += noise;
  depth(cv::Rect(100, 100, 40, 4)).setTo(0);  // a gap across the body
  EXPECT_GT(intersection_over_union(box_mask(depth, kNoise, kBox, {}), person(kBox)), 0.97);
}

// Holes as wide as a share of the image: 6 px of 640 x 480.
TEST(BoxMask, GapsAreClosedInImagesOfAnySize) {
  for (const cv::Size size : {cv::Size(320, 240), cv::Size(640, 480), cv::Size(1280, 720)}) {
    SCOPED_TRACE(size.width);
    const double scale = pixel_scale(size);
    cv::Mat depth(size, CV_32FC1, cv::Scalar(kWall));
    const cv::Rect person(size.width / 4, size.height / 4, size.width / 8, size.height / 2);
    depth(person).setTo(kPerson);
    const auto mask_with_gap = [&](double width) {
      cv::Mat holed = depth.clone();
      const int middle = person.y + person.height / 2;
      holed.rowRange(middle, middle + cvRound(width * scale)).setTo(0);
      return cv::countNonZero(box_mask(holed, kNoise, person, {}));
    };
    EXPECT_EQ(mask_with_gap(4), person.area());
    EXPECT_LT(mask_with_gap(12), person.area());
  }
}

TEST(BoxMask, IsWholeWhereTheNoiseOfTheSensorIsKnown) {
  constexpr double kSensorNoise = 0.02;  // metres at 1 m: ten times a Kinect's
  cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(kWall));
  const cv::Mat person = draw_person(depth, {120, 190});
  cv::Mat noise(depth.size(), CV_32FC1);
  cv::RNG(3).fill(noise, cv::RNG::NORMAL, 0.0, kSensorNoise * kPerson * kPerson);
  depth += noise;
  EXPECT_GT(intersection_over_union(box_mask(depth, kSensorNoise, kBox, {}), person(kBox)), 0.97);
  EXPECT_LT(intersection_over_union(box_mask(depth, kNoise, kBox, {}), person(kBox)), 0.97);
}

// The middle of the box is wall for the most part: bow legs, or an arm to the side.
TEST(BoxMask, PrefersTheNearerSurface) {
  cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(kWall));
  depth(cv::Rect(105, 40, 12, 160)).setTo(kPerson);
  const cv::Mat found = box_mask(depth, kNoise, kBox, {});
  EXPECT_EQ(cv::countNonZero(found), 12 * 160);
}

TEST(BoxMask, DoesNotRunAlongTheFloor) {
  cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(kWall));
  for (int v = 150; v < 240; ++v)  // the floor reaches the person's feet at v = 190
    depth.row(v).setTo(kPerson * 40.0f / static_cast<float>(v - 150 + 1));
  depth.setTo(kWall, depth > kWall);
  const cv::Mat person = draw_person(depth, {120, 190});
  EXPECT_GT(intersection_over_union(box_mask(depth, kNoise, kBox, {}), person(kBox)), 0.8);
}

TEST(BoxMask, WithoutDepthIsTheEllipseInTheBox) {
  for (const cv::Mat& depth : {cv::Mat(), cv::Mat(240, 320, CV_32FC1, cv::Scalar(0))}) {
    const cv::Mat found = box_mask(depth, kNoise, kBox, {});
    ASSERT_EQ(found.size(), kBox.size());
    EXPECT_NEAR(cv::countNonZero(found), CV_PI / 4 * kBox.area(), 0.03 * kBox.area());
    EXPECT_EQ(found.at<std::uint8_t>(0, 0), 0);
    EXPECT_EQ(found.at<std::uint8_t>(80, 40), 255);
  }
}

TEST(BoxMask, BoxesOfOnePixelWork) {
  const cv::Mat depth(4, 4, CV_32FC1, cv::Scalar(kPerson));
  EXPECT_EQ(cv::countNonZero(box_mask(depth, kNoise, {3, 3, 1, 1}, {})), 1);
  EXPECT_EQ(cv::countNonZero(box_mask(cv::Mat(), kNoise, {3, 3, 1, 1}, {})), 1);
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
