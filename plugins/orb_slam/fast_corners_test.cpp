#include "orb_slam/fast_corners.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace stillpoint::orb_slam {
namespace {

constexpr int kCircle[16][2] = {{0, 3},  {1, 3},  {2, 2},  {3, 1},   {3, 0},   {3, -1},
                                {2, -2}, {1, -3}, {0, -3}, {-1, -3}, {-2, -2}, {-3, -1},
                                {-3, 0}, {-3, 1}, {-2, 2}, {-1, 3}};

// The definition, word for word.
int reference_score(const cv::Mat& gray, int x, int y) {
  int best = 0;
  for (int start = 0; start < 16; ++start) {
    int brighter = 255, darker = 255;
    for (int i = start; i < start + 9; ++i) {
      const auto [dx, dy] = kCircle[i % 16];
      const int difference = gray.at<uchar>(y + dy, x + dx) - gray.at<uchar>(y, x);
      brighter = std::min(brighter, difference);
      darker = std::min(darker, -difference);
    }
    best = std::max({best, brighter, darker});
  }
  return best;
}

std::vector<Corner> reference_corners(const cv::Mat& gray, int threshold, int border) {
  cv::Mat scores(gray.size(), CV_32S, cv::Scalar(0));
  for (int y = border - 1; y <= gray.rows - border; ++y)
    for (int x = border - 1; x <= gray.cols - border; ++x)
      scores.at<int>(y, x) = reference_score(gray, x, y);
  std::vector<Corner> corners;
  for (int y = border; y < gray.rows - border; ++y) {
    for (int x = border; x < gray.cols - border; ++x) {
      const int score = scores.at<int>(y, x);
      bool largest = score > threshold;
      for (int i = 0; i < 9 && largest; ++i) {
        const int neighbour = scores.at<int>(y + i / 3 - 1, x + i % 3 - 1);
        largest = i < 4 ? score > neighbour : score >= neighbour;
      }
      if (largest) corners.push_back({x, y, score});
    }
  }
  return corners;
}

cv::Mat random_image(int width, int height, double blur) {
  cv::Mat image(height, width, CV_8UC1);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  if (blur > 0) cv::GaussianBlur(image, image, {}, blur);
  return image;
}

TEST(FastDetector, FindsWhatTheDefinitionFinds) {
  FastDetector detector;
  std::vector<Corner> corners;
  for (const cv::Size size : {cv::Size(97, 41), cv::Size(64, 64), cv::Size(173, 58)})
    for (const double blur : {0.0, 1.0, 2.0})
      for (const int threshold : {3, 7, 20, 60})
        for (const int border : {5, 19}) {
          const cv::Mat image = random_image(size.width, size.height, blur);
          detector.detect(image, threshold, border, corners);
          EXPECT_EQ(corners, reference_corners(image, threshold, border))
              << size << " blur " << blur << " threshold " << threshold << " border " << border;
        }
}

TEST(FastDetector, ReadsOnlyTheRegionOfALargerImage) {
  const cv::Mat whole = random_image(200, 100, 1);
  const cv::Mat part = whole(cv::Rect(13, 11, 90, 70));
  FastDetector detector;
  std::vector<Corner> corners, of_copy;
  detector.detect(part, 7, 5, corners);
  detector.detect(part.clone(), 7, 5, of_copy);
  EXPECT_FALSE(corners.empty());
  EXPECT_EQ(corners, of_copy);
}

TEST(FastDetector, FindsNothingInFlatOrTinyImages) {
  FastDetector detector;
  std::vector<Corner> corners = {{1, 2, 3}};
  detector.detect(cv::Mat(60, 80, CV_8UC1, cv::Scalar(255)), 7, 5, corners);
  EXPECT_TRUE(corners.empty());
  detector.detect(cv::Mat(), 7, 5, corners);
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(10, 50), cv::Size(50, 10)}) {
    detector.detect(random_image(size.width, size.height, 0), 7, 5, corners);
    EXPECT_TRUE(corners.empty()) << size;
  }
}

TEST(RefineCorner, FollowsAShiftOfAFractionOfAPixel) {
  const cv::Mat base = random_image(160, 120, 2.5);
  cv::Mat contrast, shifted;
  cv::normalize(base, contrast, 0, 255, cv::NORM_MINMAX);
  const cv::Point2d shift(0.3, -0.2);
  const cv::Mat motion = (cv::Mat_<double>(2, 3) << 1, 0, shift.x, 0, 1, shift.y);
  cv::warpAffine(contrast, shifted, motion, contrast.size(), cv::INTER_CUBIC);
  FastDetector detector;
  std::vector<Corner> before, after;
  detector.detect(contrast, 15, 20, before);
  detector.detect(shifted, 15, 20, after);
  std::vector<double> errors_refined, errors_whole;
  for (const Corner& a : before) {
    for (const Corner& b : after) {
      if (std::abs(a.x - b.x) > 1 || std::abs(a.y - b.y) > 1) continue;
      const cv::Point2d moved = refine_corner(shifted, b) - refine_corner(contrast, a);
      errors_refined.push_back(cv::norm(moved - shift));
      errors_whole.push_back(cv::norm(cv::Point2d(b.x - a.x, b.y - a.y) - shift));
    }
  }
  ASSERT_GT(errors_refined.size(), 20U);
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + std::ssize(v) / 2, v.end());
    return v[v.size() / 2];
  };
  EXPECT_LT(median(errors_refined), 0.7 * median(errors_whole));
}

}  // namespace
}  // namespace stillpoint::orb_slam
