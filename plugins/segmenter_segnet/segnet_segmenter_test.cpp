#include "segmenter_segnet/segnet_segmenter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "segmenter_segnet/test_network.hpp"
#include "segmenter_segnet/test_reference.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SegnetSegmenterTest : public ::testing::Test {
 protected:
  SegnetSegmenter::Options options_for(const TestNetwork& network) {
    SegnetSegmenter::Options options;
    options.prototxt = folder_.write("net.prototxt", network.prototxt()).string();
    options.model = folder_.write("net.caffemodel", network.caffemodel()).string();
    options.classes.clear();
    for (int i = 0; i < network.channels(); ++i)
      options.classes.push_back("class" + std::to_string(i));
    return options;
  }
  std::string message_of(const SegnetSegmenter::Options& options, Fault fault) {
    try {
      SegnetSegmenter(options, StageContext{});
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), fault);
      return error.what();
    }
    return "nothing was thrown";
  }

  stillpoint::testing::TemporaryFolder folder_;
};

/// The scores are the colours themselves: class 0 blue, 1 green, 2 red.
TestNetwork colour_network(int height, int width) {
  TestNetwork network(height, width, 1);
  network.convolution("conv1", 3, 1, false);
  std::vector<float>& weights = network.layer("conv1").blobs[0].values;
  for (std::size_t i = 0; i < 9; ++i) weights[i] = i % 4 == 0 ? 1.0f : 0.0f;
  return network.plain("ArgMax", "argmax", false, "argmax_param { axis: 1 }\n");
}

Frame frame_of(const cv::Mat& bgr, std::uint32_t index = 0) { return {.index = index, .bgr = bgr}; }

cv::Mat noise(cv::Size size) {
  cv::Mat image(size, CV_8UC3);
  cv::RNG random(3);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, {}, 3);
  return image;
}

TEST_F(SegnetSegmenterTest, LabelsAreThoseOfTheReference) {
  TestNetwork network = segnet_vgg16(45, 60, 16, 21, 2);
  SegnetSegmenter::Options options = options_for(network);
  options.min_object_pixels = 1;
  options.scale = 1.0 / 64;
  options.mean = {128, 120, 100};
  SegnetSegmenter segmenter(options, StageContext{});
  const cv::Mat image = noise({60, 45});
  const Segmentation found = segmenter.segment(frame_of(image, 7));

  cv::Mat input(4, std::vector<int>{1, 3, 45, 60}.data(), CV_32F);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 45; ++y)
      for (int x = 0; x < 60; ++x)
        input.at<float>(cv::Vec4i(0, c, y, x)) = static_cast<float>(
            (image.at<cv::Vec3b>(y, x)[c] - options.mean[static_cast<std::size_t>(c)]) / 64);
  const Tensor scores = reference_scores(network, input);
  EXPECT_EQ(found.frame, 7u);
  for (int y = 0; y < 45; ++y)
    for (int x = 0; x < 60; ++x) {
      int best = 0;
      for (int c = 1; c < scores.channels; ++c)
        if (scores.at(c, y, x) > scores.at(best, y, x)) best = c;
      ASSERT_EQ(found.labels.at<std::uint8_t>(y, x), best) << x << ", " << y;
    }
}

TEST_F(SegnetSegmenterTest, FramesOfAnySizeGetLabelsOfTheirSize) {
  SegnetSegmenter segmenter(options_for(colour_network(30, 40)), StageContext{});
  for (const cv::Size size : {cv::Size(160, 120), cv::Size(640, 480), cv::Size(53, 41)}) {
    cv::Mat image(size, CV_8UC3, cv::Scalar(200, 0, 0));
    const cv::Rect left(0, 0, size.width / 2, size.height);
    image(left).setTo(cv::Scalar(0, 0, 200));
    const Segmentation found = segmenter.segment(frame_of(image));
    ASSERT_EQ(found.labels.size(), size);
    ASSERT_EQ(found.instances.size(), size);
    ASSERT_EQ(found.objects.size(), 1u);
    EXPECT_EQ(found.objects[0].label, 2);
    EXPECT_NEAR(found.objects[0].box.width, left.width, size.width / 40.0);
    EXPECT_EQ(found.objects[0].box.height, size.height);
    EXPECT_EQ(found.objects[0].pixels, cv::countNonZero(found.labels == 2));
    EXPECT_GT(found.objects[0].score, 0.99f);
  }
}

TEST_F(SegnetSegmenterTest, PixelsOfTheNetworkLieCentredOnThoseOfTheFrame) {
  SegnetSegmenter::Options options = options_for(colour_network(12, 16));
  options.min_object_pixels = 1;
  SegnetSegmenter segmenter(options, StageContext{});
  cv::Mat image(36, 48, CV_8UC3, cv::Scalar(200, 0, 0));
  const cv::Rect cell(15, 9, 3, 3);  // the network's pixel (5, 3)
  image(cell).setTo(cv::Scalar(0, 200, 0));
  const Segmentation found = segmenter.segment(frame_of(image));
  ASSERT_EQ(found.objects.size(), 1u);
  EXPECT_EQ(found.objects[0].box, cell);
}

TEST_F(SegnetSegmenterTest, SmallObjectsAreBackground) {
  SegnetSegmenter::Options options = options_for(colour_network(48, 64));
  options.min_object_pixels = 30;
  SegnetSegmenter segmenter(options, StageContext{});
  cv::Mat image(48, 64, CV_8UC3, cv::Scalar(200, 0, 0));
  image(cv::Rect(2, 2, 5, 5)).setTo(cv::Scalar(0, 200, 0));
  image(cv::Rect(20, 20, 6, 6)).setTo(cv::Scalar(0, 0, 200));
  const Segmentation found = segmenter.segment(frame_of(image));
  ASSERT_EQ(found.objects.size(), 1u);
  EXPECT_EQ(found.objects[0].box, cv::Rect(20, 20, 6, 6));
  EXPECT_EQ(cv::countNonZero(found.labels), 36);
}

TEST_F(SegnetSegmenterTest, ChannelOrderIsThatOfTheNetwork) {
  SegnetSegmenter::Options options = options_for(colour_network(12, 16));
  options.channels = SegnetSegmenter::ChannelOrder::kRgb;
  options.mean = {150, 0, 0};  // of red
  SegnetSegmenter segmenter(options, StageContext{});
  const cv::Mat blue(12, 16, CV_8UC3, cv::Scalar(100, 0, 0));
  EXPECT_EQ(cv::countNonZero(segmenter.segment(frame_of(blue)).labels == 2), 12 * 16);
  const cv::Mat red_and_green(12, 16, CV_8UC3, cv::Scalar(0, 100, 200));
  EXPECT_EQ(cv::countNonZero(segmenter.segment(frame_of(red_and_green)).labels == 1), 12 * 16);
}

TEST_F(SegnetSegmenterTest, SameImagesGiveSameLabels) {
  const SegnetSegmenter::Options options = options_for(segnet_basic(45, 60, 8, 5, 4));
  SegnetSegmenter first(options, StageContext{}), second(options, StageContext{});
  const cv::Mat image = noise({160, 120});
  const Segmentation a = first.segment(frame_of(image)), b = second.segment(frame_of(image)),
                     c = first.segment(frame_of(image));
  for (const Segmentation* other : {&b, &c}) {
    EXPECT_EQ(cv::norm(a.labels, other->labels, cv::NORM_INF), 0.0);
    ASSERT_EQ(a.objects.size(), other->objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i)
      EXPECT_EQ(a.objects[i].score, other->objects[i].score);
  }
}

TEST_F(SegnetSegmenterTest, ClassesAreVocUnlessNamed) {
  SegnetSegmenter::Options options = options_for(segnet_vgg16(32, 32, 32, 21, 1));
  options.classes = SegnetSegmenter::Options().classes;
  EXPECT_EQ(SegnetSegmenter(options, StageContext{}).classes(), named_classes("voc21"));
  options.classes = named_classes("voc21");
  options.classes[15] = "human";
  EXPECT_EQ(SegnetSegmenter(options, StageContext{}).classes()[15], "human");
}

TEST_F(SegnetSegmenterTest, ClassesThatDoNotFitAreRefusedAtTheStart) {
  SegnetSegmenter::Options options = options_for(segnet_basic(32, 32, 4, 11, 1));
  options.classes = {"voc21"};
  EXPECT_THAT(message_of(options, Fault::kUsage),
              AllOf(HasSubstr("tells 11 classes apart"), HasSubstr("'classes' has 21 names")));
  options.classes = {"background", "person"};
  EXPECT_THAT(message_of(options, Fault::kUsage), HasSubstr("'classes' has 2 names"));
  options.classes = {"voc12"};
  EXPECT_THAT(message_of(options, Fault::kUsage), HasSubstr("did you mean 'voc21'?"));
  options.classes.clear();
  EXPECT_THAT(message_of(options, Fault::kUsage), HasSubstr("'classes' has 0 names"));
}

TEST_F(SegnetSegmenterTest, FailuresWhileRunningEndTheRunCleanly) {
  SegnetSegmenter segmenter(options_for(colour_network(12, 16)), StageContext{});
  EXPECT_THROW(segmenter.segment(frame_of(cv::Mat())), Error);
}

}  // namespace
}  // namespace stillpoint::segmenter_segnet
