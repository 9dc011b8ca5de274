#include "segmenter_opencv_dnn/detections.hpp"

#include <gtest/gtest.h>

#include "stillpoint/error.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

cv::Mat ssd(std::vector<float> values) {
  const int size[] = {1, 1, static_cast<int>(values.size() / 7), 7};
  return cv::Mat(4, size, CV_32FC1, values.data()).clone();
}

TEST(Detections, ReadsRegions) {
  // Two classes. The second row overlaps the first, the third is of the other class, the last weak.
  const cv::Mat region = (cv::Mat_<float>(4, 7) <<  //
                              0.5f,
                          0.5f, 0.2f, 0.4f, 0.9f, 0.8f, 0.1f,         //
                          0.51f, 0.5f, 0.2f, 0.4f, 0.9f, 0.9f, 0.1f,  //
                          0.5f, 0.5f, 0.2f, 0.4f, 0.9f, 0.0f, 0.7f,   //
                          0.1f, 0.1f, 0.1f, 0.1f, 0.5f, 0.4f, 0.0f);
  ASSERT_TRUE(holds_boxes(region, 3));
  const auto found = detections({region}, 3, 0.5, 0.4);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].label, 1);
  EXPECT_FLOAT_EQ(found[0].score, 0.9f);
  EXPECT_NEAR(found[0].box.x, 0.41, 1e-6);
  EXPECT_NEAR(found[0].box.y, 0.3, 1e-6);
  EXPECT_NEAR(found[0].box.width, 0.2, 1e-6);
  EXPECT_EQ(found[1].label, 2);
}

TEST(Detections, ReadsSsd) {
  const cv::Mat output = ssd({0, 2, 0.7f, 0.1f, 0.2f, 0.5f, 0.8f,  //
                              0, 0, 0.9f, 0,    0,    1,    1,     // background
                              0, 1, 0.2f, 0,    0,    1,    1});
  ASSERT_TRUE(holds_boxes(output, 3));
  const auto found = detections({output}, 3, 0.5, 0.4);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].label, 2);
  EXPECT_NEAR(found[0].box.width, 0.4, 1e-6);
  EXPECT_NEAR(found[0].box.height, 0.6, 1e-6);
}

TEST(Detections, RefusesClassesBeyondTheList) {
  EXPECT_THROW(detections({ssd({0, 5, 0.9f, 0, 0, 1, 1})}, 3, 0.5, 0.4), Error);
  EXPECT_TRUE(detections({ssd({0, 5, 0.1f, 0, 0, 1, 1})}, 3, 0.5, 0.4).empty());
}

TEST(Detections, KnowsOtherShapes) {
  EXPECT_FALSE(holds_boxes(cv::Mat(10, 7, CV_32FC1), 81));
  const int planes[] = {1, 1, 10, 8};
  EXPECT_FALSE(holds_boxes(cv::Mat(4, planes, CV_32FC1), 3));
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
