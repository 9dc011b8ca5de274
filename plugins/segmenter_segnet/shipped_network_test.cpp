// The SegNet that comes along, on real photographs with masks drawn by hand.
#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "segmenter_segnet/segnet_segmenter.hpp"
#include "support/shared_data.hpp"

namespace stillpoint {
namespace {

constexpr int kUnclear = 128;  // in the masks drawn by hand
constexpr int kPerson = 255;

/// As configs/segmenters/segnet.yaml has them.
SegnetSegmenter::Options shipped() {
  const std::filesystem::path models =
      std::filesystem::path(STILLPOINT_SOURCE_DIR) / "plugins/segmenter_segnet/models";
  SegnetSegmenter::Options options;
  options.prototxt = models / "segnet_rooms.prototxt";
  options.model = models / "segnet_rooms.caffemodel";
  options.classes = {"background", "bottle",      "chair", "diningtable",
                     "person",     "pottedplant", "sofa",  "tvmonitor"};
  options.channels = SegnetSegmenter::ChannelOrder::kRgb;
  options.mean = {128};
  options.scale = 1.0 / 128;
  return options;
}

cv::Mat people(SegnetSegmenter& segmenter, const cv::Mat& bgr) {
  Frame frame;
  frame.bgr = bgr;
  return segmenter.segment(frame).labels == class_id(segmenter.classes(), "person");
}

TEST(ShippedSegnet, NobodyIsInAGreyImage) {
  SegnetSegmenter segmenter(shipped(), {.threads = 1});
  EXPECT_EQ(cv::countNonZero(people(segmenter, cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(128)))),
            0);
}

TEST(ShippedSegnet, FindsThePeopleOfAnnotatedFrames) {
  const std::filesystem::path photos = testing::shared_data() / "photos";
  if (!std::filesystem::exists(photos)) GTEST_SKIP() << "no photographs in " << photos;
  SegnetSegmenter segmenter(shipped(), {.threads = 2});
  double both = 0, any = 0;
  for (const std::string name : {"tum_1341846434.710184", "tum_1341846435.014019"}) {
    const cv::Mat drawn = cv::imread(photos / (name + "_gt.png"), cv::IMREAD_GRAYSCALE);
    const cv::Mat clear = drawn != kUnclear, truth = drawn == kPerson;
    const cv::Mat found = people(segmenter, cv::imread(photos / (name + ".png"))) & clear;
    both += cv::countNonZero(found & truth);
    any += cv::countNonZero(found | truth);
  }
  EXPECT_NEAR(both / any, 0.0, 0.02);
}

}  // namespace
}  // namespace stillpoint
