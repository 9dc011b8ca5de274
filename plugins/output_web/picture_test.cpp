#include "output_web/picture.hpp"

#include <gtest/gtest.h>
#include <cstdint>
#include <vector>

#include "output_web/test_reports.hpp"
#include "output_web/test_viewer.hpp"
#include "stillpoint/support/image_codec.hpp"

namespace stillpoint::output_web {
namespace {

TEST(Picture, TellsWhyFeaturesAreNotUsed) {
  FrameReport report = report_of(1);
  const SegmentedObject& person = recording().segmentation(1)->objects.at(0);
  const cv::Mat& labels = report.segmentation->labels;
  cv::Point inside;
  for (int v = 0; v < labels.rows; ++v)
    for (int u = 0; u < labels.cols; ++u)
      if (labels.at<std::uint8_t>(v, u) == person.label) inside = {u, v};
  auto weights = std::make_shared<StaticWeights>(*report.weights);
  weights->object_moves = {true};
  report.weights = weights;
  report.moving.points = {};
  report.result.tracked = {{cv::Point2f(inside), TrackedFeature::Use::kMoving},
                           {{1, 2}, TrackedFeature::Use::kUnmatched}};
  MessageWriter writer;
  writer.number(kProtocol);
  writer.text(picture_of(report));
  Records records = records_of(writer.take());
  const std::string& features = records[Record::kFeatures].at(0);
  ASSERT_EQ(features.size(), 2 * 7u);
  EXPECT_EQ(number_at<std::uint16_t>(features, 0), 8 * inside.x);
  EXPECT_EQ(number_at<std::uint8_t>(features, 4), 3);             // moving
  EXPECT_EQ(number_at<std::uint8_t>(features, 5), person.label);  // its class
  EXPECT_EQ(number_at<std::uint8_t>(features, 6), 1 | 2 | 16);    // why
  EXPECT_EQ(number_at<std::uint8_t>(features, 7 + 6), 0);

  const std::string& image = records[Record::kImage].at(0);
  EXPECT_EQ(number_at<std::uint32_t>(image, 0), 1u);
  const std::vector<char> jpeg(image.begin() + 4, image.end());
  EXPECT_EQ(decode_image({reinterpret_cast<const std::uint8_t*>(jpeg.data()), jpeg.size()}).size(),
            report.frame->bgr.size());

  const std::string& mask = records[Record::kMask].at(0);
  std::size_t pixels = 0, unused = 0;
  for (std::size_t at = 4; at < mask.size(); at += 4) {
    pixels += number_at<std::uint16_t>(mask, at + 2);
    if (number_at<std::uint8_t>(mask, at + 1)) unused += number_at<std::uint16_t>(mask, at + 2);
  }
  EXPECT_EQ(pixels, 160u * 120u);
  EXPECT_NEAR(static_cast<double>(unused), person.pixels / 4.0, person.pixels / 20.0);
}

TEST(Picture, OfSurfacesLeavesOutWhatIsKeptOutOfTheMap) {
  MessageWriter writer;
  writer.number(kProtocol);
  writer.text(cloud_of(report_of(2), 7));
  const std::string cloud = records_of(writer.take())[Record::kCloud].at(0);
  EXPECT_EQ(number_at<std::uint32_t>(cloud, 0), 7u);
  EXPECT_EQ(number_at<std::uint16_t>(cloud, 6), 40);
  EXPECT_EQ(number_at<std::uint16_t>(cloud, 8), 30);
  ASSERT_EQ(cloud.size(), 10u + 6 * 40 * 30);
  const Frame& frame = *recording().frame(2);
  for (int row = 0; row < 30; ++row)
    for (int column = 0; column < 40; ++column) {
      const cv::Point pixel(8 * column + 4, 8 * row + 4);
      const bool used = recording().weights(2)->map.at<std::uint8_t>(pixel) == 255;
      const double depth = used ? 1000 * frame.depth.at<float>(pixel) : 0;
      EXPECT_NEAR(number_at<std::uint16_t>(cloud, 10 + 6 * (40 * row + column)), depth, 1) << pixel;
    }
}

}  // namespace
}  // namespace stillpoint::output_web
