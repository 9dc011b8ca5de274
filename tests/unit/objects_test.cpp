// From labels to objects.
#include "stillpoint/support/objects.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "stillpoint/class_names.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

TEST(FindObjects, NamesTheConnectedPartsOfEachClassLargestFirst) {
  Segmentation s{.labels = cv::Mat::zeros(40, 60, CV_8UC1)};
  s.labels(cv::Rect(5, 5, 10, 20)) = 15;
  s.labels(cv::Rect(15, 5, 4, 20)) = 9;  // touches, of another class
  s.labels(cv::Rect(40, 10, 15, 15)) = 15;
  find_objects(s, 1);
  ASSERT_EQ(s.objects.size(), 3u);
  EXPECT_EQ(s.objects[0].box, cv::Rect(40, 10, 15, 15));
  EXPECT_EQ(s.objects[1].pixels, 200);
  EXPECT_EQ(s.objects[2].label, 9);
  EXPECT_EQ(s.instances.at<std::uint8_t>(12, 45), 1);
  EXPECT_EQ(s.instances.at<std::uint8_t>(12, 8), 2);
  EXPECT_EQ(s.instances.at<std::uint8_t>(12, 16), 3);
  EXPECT_EQ(s.instances.at<std::uint8_t>(0, 0), 0);
}

TEST(FindObjects, DiagonalNeighboursAreConnectedAndSpecksBecomeBackground) {
  Segmentation s{.labels = cv::Mat::zeros(20, 20, CV_8UC1)};
  s.labels(cv::Rect(2, 2, 4, 4)) = 15;
  s.labels(cv::Rect(6, 6, 4, 4)) = 15;
  s.labels.at<std::uint8_t>(18, 18) = 15;
  const cv::Mat given = s.labels;
  find_objects(s, 2);
  ASSERT_EQ(s.objects.size(), 1u);
  EXPECT_EQ(s.objects[0].pixels, 32);
  EXPECT_EQ(s.labels.at<std::uint8_t>(18, 18), 0);
  EXPECT_EQ(given.at<std::uint8_t>(18, 18), 15);  // others may hold the image that came in
}

TEST(FindObjects, KeepsTheLargest255) {
  Segmentation s{.labels = cv::Mat::zeros(80, 80, CV_8UC1)};
  for (int y = 0; y < 80; y += 4)
    for (int x = 0; x < 80; x += 4) s.labels.at<std::uint8_t>(y, x) = 7;
  s.labels(cv::Rect(76, 76, 2, 2)) = 7;
  find_objects(s, 1);
  ASSERT_EQ(s.objects.size(), 255u);
  EXPECT_EQ(s.objects[0].pixels, 4);
  EXPECT_EQ(cv::countNonZero(s.labels), 258);
}

TEST(FindObjects, UnknownStaysUnknown) {
  Segmentation s;
  find_objects(s, 1);
  EXPECT_FALSE(s.known());
  EXPECT_TRUE(s.objects.empty());
}

TEST(ClassNames, ListsByName) {
  EXPECT_EQ(named_classes("voc21").size(), 21u);
  EXPECT_EQ(named_classes("coco80").size(), 81u);
  EXPECT_EQ(class_id(named_classes("voc21"), "person"), 15);
  EXPECT_EQ(class_id(named_classes("coco80"), "toothbrush"), 80);
}

TEST(ClassNames, UnknownNamesAreExplained) {
  try {
    class_id(named_classes("voc21"), "persn");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_NE(std::string(error.what()).find("did you mean 'person'?"), std::string::npos);
  }
  EXPECT_THROW(named_classes("voc"), Error);
  EXPECT_THROW(class_id({}, "person"), Error);
}

}  // namespace
}  // namespace stillpoint
