#include "segmenter_opencv_dnn/cell_labels.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace stillpoint::segmenter_opencv_dnn {
namespace {

std::vector<ScorePlane> random_planes(int count, cv::Size cells) {
  cv::RNG random(7);
  std::vector<ScorePlane> planes;
  for (int i = 0; i < count; ++i) {
    planes.push_back({cv::Mat(cells, CV_32FC1), i});
    random.fill(planes.back().scores, cv::RNG::NORMAL, 0.0, 1.0);
  }
  return planes;
}

double score_at(const cv::Mat& scores, const CellPosition& x, const CellPosition& y) {
  const int right = std::min(x.cell + 1, scores.cols - 1);
  const int below = std::min(y.cell + 1, scores.rows - 1);
  const auto between = [](double a, double b, double share) { return a + share * (b - a); };
  return between(
      between(scores.at<float>(y.cell, x.cell), scores.at<float>(y.cell, right), x.share),
      between(scores.at<float>(below, x.cell), scores.at<float>(below, right), x.share), y.share);
}

// Plainly: all planes at all pixels.
TEST(LabelPixels, TakesTheHighestInterpolatedScore) {
  const auto planes = random_planes(21, {9, 7});
  const CellGrid grid(CellAlignment::kCorners, {9, 7}, {129, 97}, {200, 150});
  const cv::Mat labels = label_pixels(planes, grid);
  ASSERT_EQ(labels.size(), cv::Size(200, 150));
  for (int v = 0; v < 150; ++v)
    for (int u = 0; u < 200; ++u) {
      const CellPosition& x = grid.columns[static_cast<std::size_t>(u)];
      const CellPosition& y = grid.rows[static_cast<std::size_t>(v)];
      const double score = score_at(planes[labels.at<std::uint8_t>(v, u)].scores, x, y);
      for (const ScorePlane& plane : planes)
        ASSERT_GE(score + 1e-5, score_at(plane.scores, x, y)) << u << ", " << v;
    }
}

TEST(LabelPixels, FirstOfEqualPlanesWins) {
  const cv::Mat same(3, 3, CV_32FC1, cv::Scalar(0.5));
  const CellGrid grid(CellAlignment::kCentres, {3, 3}, {3, 3}, {12, 12});
  EXPECT_EQ(cv::countNonZero(label_pixels({{same, 0}, {same, 1}}, grid)), 0);
}

TEST(LabelPixels, WorksOnOnePixelAndOneCell) {
  const cv::Mat one(1, 1, CV_32FC1, cv::Scalar(1));
  const CellGrid grid(CellAlignment::kCentres, {1, 1}, {8, 8}, {1, 1});
  EXPECT_EQ(label_pixels({{one * 0, 0}, {one, 3}}, grid).at<std::uint8_t>(0), 3);
}

TEST(ScoreObjects, IsTheMeanProbabilityOfTheirPixels) {
  Segmentation segmentation;
  segmentation.instances = (cv::Mat_<std::uint8_t>(2, 4) << 1, 1, 0, 2, 1, 0, 0, 2);
  segmentation.objects = {{.label = 1, .box = {0, 0, 2, 2}, .pixels = 3},
                          {.label = 2, .box = {3, 0, 1, 2}, .pixels = 2}};
  const cv::Mat first = (cv::Mat_<float>(2, 4) << 0.9f, 0.6f, 0, 0, 0.3f, 0, 0, 0);
  const cv::Mat second = (cv::Mat_<float>(2, 4) << 0, 0, 0, 0.5f, 0, 0, 0, 1.0f);
  score_objects(segmentation, {cv::Mat(), first, second},
                CellGrid(CellAlignment::kCentres, {4, 2}, {4, 2}, {4, 2}));
  EXPECT_NEAR(segmentation.objects[0].score, 0.6, 1e-6);
  EXPECT_NEAR(segmentation.objects[1].score, 0.75, 1e-6);
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
