#include "segmenter_opencv_dnn/opencv_dnn_segmenter.hpp"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "segmenter_opencv_dnn/test_networks.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

using ::testing::ElementsAre;
using Options = OpenCvDnnSegmenter::Options;

Options with(const NetworkOptions& network, ResultKind result, std::vector<std::string> classes) {
  Options options;
  options.network = network;
  options.rule.result = result;
  options.classes = std::move(classes);
  options.smallest.pixels = 1;
  return options;
}

cv::Mat noise(cv::Size size) {
  cv::Mat image(size, CV_8UC3);
  cv::RNG(5).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

/// Head and shoulders, enough for the shipped network.
cv::Mat portrait() {
  cv::Mat image(240, 320, CV_8UC3, cv::Scalar(170, 180, 180));
  cv::ellipse(image, {120, 230}, {80, 100}, 0, 0, 360, {110, 60, 40}, cv::FILLED);
  cv::ellipse(image, {120, 90}, {34, 46}, 0, 0, 360, {140, 170, 215}, cv::FILLED);
  cv::ellipse(image, {120, 60}, {38, 26}, 0, 180, 360, {30, 40, 50}, cv::FILLED);
  return image;
}

TEST(OpenCvDnnSegmenter, DefaultsAreTheShippedNetwork) {
  Options options;
  options.network.model = shipped_model();
  OpenCvDnnSegmenter segmenter(options, {});
  EXPECT_THAT(segmenter.classes(), ElementsAre("background", "person"));
  Frame frame;
  frame.index = 7;
  frame.bgr = cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(128));
  const Segmentation result = segmenter.segment(frame);
  EXPECT_EQ(result.frame, 7u);
  EXPECT_EQ(result.labels.size(), frame.bgr.size());
  EXPECT_EQ(cv::countNonZero(result.labels), 0);
}

TEST(OpenCvDnnSegmenter, SameImageSameResult) {
  Options options;
  options.network.model = shipped_model();
  OpenCvDnnSegmenter first(options, {}), second(options, {});
  Frame frame;
  frame.bgr = portrait();
  const Segmentation a = first.segment(frame);
  EXPECT_FALSE(a.objects.empty());
  first.segment(blocks(noise({4, 3}), 8));  // another image, of another size, in between
  for (const Segmentation& b : {first.segment(frame), second.segment(frame)}) {
    EXPECT_EQ(cv::norm(a.labels, b.labels, cv::NORM_INF), 0);
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i)
      EXPECT_EQ(a.objects[i].score, b.objects[i].score);
  }
}

TEST(OpenCvDnnSegmenter, ATensorFlowNetworkGivesTheSameAsItsTwinOfCaffe) {
  const testing::TemporaryFolder folder;
  constexpr int kStride = 4;
  const cv::Size input(33, 25);
  Frame frame;
  frame.bgr = noise(input);
  const auto labels = [&](const NetworkOptions& network) {
    return OpenCvDnnSegmenter(with(network, ResultKind::kClassLogits, {"background", "cat", "dog"}),
                              {})
        .segment(frame)
        .labels;
  };
  const cv::Mat tensorflow = labels(tensorflow_network(folder, kStride, input));
  EXPECT_EQ(cv::norm(tensorflow, labels(caffe_network(folder, subsampling(kStride), input)),
                     cv::NORM_INF),
            0);
  for (int label = 0; label < 3; ++label) EXPECT_GT(cv::countNonZero(tensorflow == label), 0);
}

// Every 16th pixel of the input is a cell: between two of them the scores are linear.
TEST(OpenCvDnnSegmenter, LogitsOfStride16AreAlignedExactly) {
  const testing::TemporaryFolder folder;
  Options options = with(caffe_network(folder, subsampling(16), {33, 17}), ResultKind::kClassLogits,
                         {"background", "cat", "dog"});
  options.cells = CellAlignment::kCorners;
  OpenCvDnnSegmenter segmenter(options, {});
  Frame frame;
  frame.bgr = cv::Mat(17, 33, CV_8UC3, cv::Scalar::all(0));
  const cv::Vec3b background(0, 0, 200), cat(0, 80, 0), dog(100, 0, 0);
  for (int y = 0; y <= 16; y += 16) {
    frame.bgr.at<cv::Vec3b>(y, 0) = cat;
    frame.bgr.at<cv::Vec3b>(y, 16) = background;
    frame.bgr.at<cv::Vec3b>(y, 32) = dog;
  }
  const Segmentation result = segmenter.segment(frame);
  for (int x = 0; x < 33; ++x) {
    // 80 (1 - s) > 200 s up to s = 2/7, x = 4.57; 100 s > 200 (1 - s) from s = 2/3, x = 26.67 on.
    const int expected = x <= 4 ? 1 : x >= 27 ? 2 : 0;
    EXPECT_EQ(result.labels.at<std::uint8_t>(8, x), expected) << x;
  }
  ASSERT_EQ(result.objects.size(), 2u);
  EXPECT_EQ(result.objects[0].label, 2);
  EXPECT_EQ(result.objects[0].box, cv::Rect(27, 0, 6, 17));
}

TEST(OpenCvDnnSegmenter, MarginIsTheLeadOverTheBackground) {
  const testing::TemporaryFolder folder;
  const Frame frame = blocks((cv::Mat_<cv::Vec3b>(1, 3) << cv::Vec3b(50, 60, 0),
                              cv::Vec3b(50, 40, 0), cv::Vec3b(50, 0, 90)),
                             1);
  Options options = with(caffe_network(folder, subsampling(1), {3, 1}), ResultKind::kClassLogits,
                         {"background", "cat", "dog"});
  const auto labels = [&](double margin) {
    options.rule.margin = margin;
    const cv::Mat found = OpenCvDnnSegmenter(options, {}).segment(frame).labels;
    return std::vector<int>(found.begin<std::uint8_t>(), found.end<std::uint8_t>());
  };
  EXPECT_THAT(labels(0), ElementsAre(1, 0, 2));
  EXPECT_THAT(labels(20), ElementsAre(0, 0, 2));
  EXPECT_THAT(labels(-20), ElementsAre(1, 1, 2));
}

TEST(OpenCvDnnSegmenter, ProbabilitiesOfClassesNeedTheThreshold) {
  const testing::TemporaryFolder folder;
  NetworkOptions network = caffe_network(folder, subsampling(1), {3, 1});
  network.scale = {0.01};
  Options options = with(network, ResultKind::kClassProbabilities, {"background", "cat", "dog"});
  const Frame frame = blocks((cv::Mat_<cv::Vec3b>(1, 3) << cv::Vec3b(10, 60, 30),
                              cv::Vec3b(20, 45, 35), cv::Vec3b(60, 10, 30)),
                             1);
  const Segmentation result = OpenCvDnnSegmenter(options, {}).segment(frame);
  EXPECT_EQ(cv::countNonZero(result.labels), 1);
  EXPECT_EQ(result.labels.at<std::uint8_t>(0), 1);
  EXPECT_NEAR(result.objects.front().score, 0.6, 1e-6);
}

TEST(OpenCvDnnSegmenter, OneProbabilityOrLogit) {
  const testing::TemporaryFolder folder;
  NetworkOptions network = caffe_network(folder, red_channel(), {4, 1});
  network.output = "out";
  network.scale = {0.01};
  const Frame frame = blocks((cv::Mat_<cv::Vec3b>(1, 4) << cv::Vec3b(90, 0, 0), cv::Vec3b(49, 0, 0),
                              cv::Vec3b(51, 0, 0), cv::Vec3b(0, 200, 200)),
                             1);
  Options options = with(network, ResultKind::kProbability, {"person"});
  const cv::Mat expected = (cv::Mat_<std::uint8_t>(1, 4) << 1, 0, 1, 0);
  OpenCvDnnSegmenter by_probability(options, {});
  EXPECT_EQ(cv::norm(by_probability.segment(frame).labels, expected, cv::NORM_INF), 0);

  options.rule.result = ResultKind::kLogit;
  options.network.mean = {50};
  OpenCvDnnSegmenter by_logit(options, {});
  const Segmentation result = by_logit.segment(frame);
  EXPECT_EQ(cv::norm(result.labels, expected, cv::NORM_INF), 0);
  EXPECT_NEAR(result.objects.front().score, 1 / (1 + std::exp(-0.4)), 1e-6);
}

TEST(OpenCvDnnSegmenter, DarkImagesAreBrightenedAndToldOfOnce) {
  const testing::TemporaryFolder folder;
  NetworkOptions network = caffe_network(folder, red_channel(), {4, 1});
  network.output = "out";
  network.scale = {0.01};
  network.brighten_to = 195;
  const Frame dark = blocks((cv::Mat_<cv::Vec3b>(1, 4) << cv::Vec3b(30, 0, 0), cv::Vec3b(16, 0, 0),
                             cv::Vec3b(17, 0, 0), cv::Vec3b(0, 65, 65)),
                            1);
  const Frame black = blocks(cv::Mat_<cv::Vec3b>::zeros(1, 4), 1);
  int told = 0;
  StageContext context;
  context.log = [&](LogLevel level, std::string_view) { told += level == LogLevel::kWarning; };
  OpenCvDnnSegmenter segmenter(with(network, ResultKind::kProbability, {"person"}), context);
  EXPECT_EQ(cv::countNonZero(segmenter.segment(black).labels), 0);
  EXPECT_EQ(told, 0);
  const cv::Mat expected = (cv::Mat_<std::uint8_t>(1, 4) << 1, 0, 1, 0);
  for (int i = 0; i < 2; ++i)  // 0.90, 0.48, 0.51 and 0
    EXPECT_EQ(cv::norm(segmenter.segment(dark).labels, expected, cv::NORM_INF), 0);
  EXPECT_EQ(told, 1);
}

TEST(OpenCvDnnSegmenter, ChannelsScaleAndMean) {
  const testing::TemporaryFolder folder;
  NetworkOptions network = caffe_network(folder, subsampling(1), {1, 1});
  network.channels = ChannelOrder::kBgr;
  network.scale = {1.0, 2.0, 1.0};
  network.mean = {0, 0, 90};
  Options options = with(network, ResultKind::kClassLogits, {"blue", "green", "red"});
  const Frame frame = blocks((cv::Mat_<cv::Vec3b>(1, 1) << cv::Vec3b(120, 40, 60)), 1);
  // blue 60, green 2 * 40, red 120 - 90
  EXPECT_EQ(OpenCvDnnSegmenter(options, {}).segment(frame).labels.at<std::uint8_t>(0), 1);
}

TEST(OpenCvDnnSegmenter, SmallObjectsAreBackground) {
  const testing::TemporaryFolder folder;
  Options options = with(caffe_network(folder, subsampling(1), {4, 4}), ResultKind::kClassLogits,
                         {"background", "cat", "dog"});
  options.smallest.pixels = 3;
  Frame frame;
  frame.bgr = cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(0));
  frame.bgr(cv::Rect(0, 0, 1, 2)).setTo(cv::Scalar(0, 255, 0));
  frame.bgr(cv::Rect(3, 0, 1, 3)).setTo(cv::Scalar(0, 255, 0));
  const Segmentation result = OpenCvDnnSegmenter(options, {}).segment(frame);
  ASSERT_EQ(result.objects.size(), 1u);
  EXPECT_EQ(result.objects[0].pixels, 3);
  EXPECT_EQ(cv::countNonZero(result.labels), 3);
}

// The network's edge is four cells off the image's.
TEST(OpenCvDnnSegmenter, RefinementSnapsToEdges) {
  const testing::TemporaryFolder folder;
  NetworkOptions network = caffe_network(folder, red_channel(), {64, 48});
  network.output = "out";
  network.scale = {1.0 / 255};
  Options options = with(network, ResultKind::kProbability, {"person"});
  Frame frame;
  frame.bgr = cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(0));
  frame.bgr(cv::Rect(0, 0, 36, 48)).setTo(cv::Scalar::all(255));
  frame.gray = cv::Mat(48, 64, CV_8UC1, cv::Scalar(50));
  frame.gray(cv::Rect(0, 0, 32, 48)).setTo(200);
  const auto width = [&] {
    return cv::countNonZero(OpenCvDnnSegmenter(options, {}).segment(frame).labels.row(24));
  };
  EXPECT_EQ(width(), 36);
  options.refinement.radius = 12;
  EXPECT_EQ(width(), 32);
}

TEST(OpenCvDnnSegmenter, DarknetBoxesBecomeMasksByDepth) {
  const testing::TemporaryFolder folder;
  OpenCvDnnSegmenter segmenter(
      with(darknet_network(folder), ResultKind::kBoxes, {"background", "cat", "dog"}), {});
  Frame frame;
  frame.bgr = cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(90));  // the box is 16, 12, 32 x 24
  frame.depth = cv::Mat(48, 64, CV_32FC1, cv::Scalar(3));
  frame.depth(cv::Rect(26, 0, 10, 48)).setTo(1);  // reaches out of the box
  const Segmentation result = segmenter.segment(frame);
  ASSERT_EQ(result.objects.size(), 1u);
  EXPECT_EQ(result.objects[0].label, 1);
  EXPECT_NEAR(result.objects[0].score, 0.95 * 0.9, 1e-4);
  EXPECT_EQ(result.objects[0].box, cv::Rect(26, 12, 10, 24));
  EXPECT_EQ(result.objects[0].pixels, 240);
  EXPECT_EQ(cv::countNonZero(result.labels == 1), 240);
  EXPECT_EQ(cv::countNonZero(result.instances == 1), 240);

  frame.depth = cv::Mat();
  const double ellipse = CV_PI / 4 * 32 * 24;
  EXPECT_NEAR(segmenter.segment(frame).objects.at(0).pixels, ellipse, 0.1 * ellipse);
}

// The image is 7 numbers wide: each row of it is a detection.
TEST(OpenCvDnnSegmenter, SsdBoxesBetterOnesOnTop) {
  const testing::TemporaryFolder folder;
  NetworkOptions network = caffe_network(folder, red_channel(), {7, 2});
  network.output = "out";
  network.scale = {1.0 / 64};
  OpenCvDnnSegmenter segmenter(with(network, ResultKind::kBoxes, {"background", "cat", "dog"}), {});
  cv::Mat rows(2, 7, CV_8UC3, cv::Scalar::all(0));
  const int detections[2][7] = {{0, 64, 60, 16, 0, 48, 64},   // a cat in the middle, of 0.94
                                {0, 128, 50, 0, 0, 32, 64}};  // a dog on the left half, of 0.78
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 7; ++x) rows.at<cv::Vec3b>(y, x)[0] = static_cast<uchar>(detections[y][x]);
  Frame frame = blocks(rows, 8);  // 56 x 16: the cat covers 14 to 42, the dog 0 to 28
  frame.depth = cv::Mat(16, 56, CV_32FC1, cv::Scalar(2));
  frame.depth(cv::Rect(0, 0, 28, 16)).setTo(1);
  const Segmentation result = segmenter.segment(frame);
  // The nearest surface of both is the left half of the image.
  ASSERT_EQ(result.objects.size(), 2u);
  EXPECT_EQ(result.objects[0].label, 2);
  EXPECT_EQ(result.objects[0].box, cv::Rect(0, 0, 14, 16));
  EXPECT_EQ(result.objects[1].label, 1);
  EXPECT_EQ(result.objects[1].box, cv::Rect(14, 0, 14, 16));
  EXPECT_NEAR(result.objects[1].score, 60.0 / 64, 1e-6);
  EXPECT_EQ(cv::countNonZero(result.labels), 28 * 16);
}

TEST(OpenCvDnnSegmenter, EverySecondImageIsSeenInAMirror) {
  Options options;
  options.network.model = shipped_model();
  OpenCvDnnSegmenter plain(options, {});
  options.mirror = true;
  OpenCvDnnSegmenter segmenter(options, {});
  Frame frame, turned;
  frame.bgr = portrait();
  cv::flip(frame.bgr, turned.bgr, 1);
  const Segmentation as_is = plain.segment(frame), in_mirror = plain.segment(turned);
  for (const bool second : {false, true, false}) {
    const Segmentation result = segmenter.segment(frame);
    cv::Mat labels = as_is.labels.clone();
    if (second) cv::flip(in_mirror.labels, labels, 1);
    EXPECT_EQ(cv::norm(result.labels, labels, cv::NORM_INF), 0);
    ASSERT_EQ(result.objects.size(), (second ? in_mirror : as_is).objects.size());
    ASSERT_FALSE(result.objects.empty());
    for (std::size_t i = 0; i < result.objects.size(); ++i)
      EXPECT_EQ(result.objects[i].box, cv::boundingRect(result.instances == 1.0 + i));
  }
  EXPECT_GT(cv::norm(segmenter.segment(frame).labels, as_is.labels, cv::NORM_INF), 0);
}

TEST(OpenCvDnnSegmenter, OpenCvFailingAtRunTimeNamesTheNetwork) {
  Options options;
  options.network.model = shipped_model();
  OpenCvDnnSegmenter segmenter(options, {});
  ::testing::internal::CaptureStderr();
  try {
    segmenter.segment(Frame{});  // no image
    FAIL() << "no fault";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kStage);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("selfie_segmentation_landscape.onnx"));
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
