#include "segmenter_segnet/class_picking.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stillpoint::segmenter_segnet {
namespace {

/// Three classes at four pixels.
cv::Mat scores(const std::vector<std::vector<float>>& of_pixels) {
  const std::vector<int> shape{1, 3, 2, 2};
  cv::Mat result(4, shape.data(), CV_32F);
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < 4; ++i)
      result.ptr<float>(0, c)[i] = of_pixels[i][static_cast<std::size_t>(c)];
  return result;
}

TEST(PickClasses, HighestScoreWinsAndTheFirstOfEquals) {
  const PickedClasses picked =
      pick_classes(scores({{1, 2, 3}, {-1, -5, -9}, {4, 7, 7}, {2, 2, 2}}));
  EXPECT_EQ(picked.labels.at<std::uint8_t>(0, 0), 2);
  EXPECT_EQ(picked.labels.at<std::uint8_t>(0, 1), 0);
  EXPECT_EQ(picked.labels.at<std::uint8_t>(1, 0), 1);
  EXPECT_EQ(picked.labels.at<std::uint8_t>(1, 1), 0);
}

TEST(PickClasses, ProbabilityIsTheSoftmax) {
  const PickedClasses picked =
      pick_classes(scores({{1, 2, 3}, {0, 500, -500}, {0, 1, 0}, {9, 0, 0}}));
  EXPECT_NEAR(picked.probability.at<float>(0, 0),
              std::exp(3.0) / (std::exp(1.0) + std::exp(2.0) + std::exp(3.0)), 1e-6);
  EXPECT_EQ(picked.probability.at<float>(0, 1), 1.0f) << "large scores do not overflow";
  EXPECT_NEAR(picked.probability.at<float>(1, 0), std::exp(1.0) / (2 + std::exp(1.0)), 1e-6);
}

TEST(ScoreObjects, ScoreIsTheMeanOverTheObjectOnly) {
  Segmentation segmentation;
  segmentation.instances = (cv::Mat_<std::uint8_t>(2, 3) << 1, 1, 2, 0, 1, 2);
  segmentation.objects = {{.label = 1, .box = {0, 0, 2, 2}}, {.label = 1, .box = {2, 0, 1, 2}}};
  score_objects(segmentation, (cv::Mat_<float>(2, 3) << 0.9, 0.6, 0.5, 0.1, 0.3, 0.7));
  EXPECT_NEAR(segmentation.objects[0].score, 0.6, 1e-6);
  EXPECT_NEAR(segmentation.objects[1].score, 0.6, 1e-6);
}

}  // namespace
}  // namespace stillpoint::segmenter_segnet
