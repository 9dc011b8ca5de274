// Person masks of real photographs against masks drawn by hand, for the shipped network and the
// larger ones.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "segmenter_opencv_dnn/test_networks.hpp"
#include "support/image_io.hpp"
#include "support/shared_data.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

namespace fs = std::filesystem;
using testing::shared_data;
using Options = OpenCvDnnSegmenter::Options;

constexpr double kTolerance = 0.02;
constexpr int kUnclear = 128;  // in the masks drawn by hand
const std::vector<std::string> kPhotos = {"tum_1341846434.710184", "tum_1341846435.014019"};

struct Overlap {
  double both = 0;
  double any = 0;
  double iou() const { return both / any; }
};

Overlap person_overlap(OpenCvDnnSegmenter& segmenter, const std::string& photo) {
  Frame frame;
  frame.bgr = testing::read_image(shared_data() / "photos" / (photo + ".png"));
  cv::cvtColor(frame.bgr, frame.gray, cv::COLOR_BGR2GRAY);
  const cv::Mat drawn =
      testing::read_image(shared_data() / "photos" / (photo + "_gt.png"), cv::IMREAD_GRAYSCALE);
  const cv::Mat clear = drawn != kUnclear;
  const cv::Mat person = drawn == 255;
  const cv::Mat found =
      (segmenter.segment(frame).labels == class_id(segmenter.classes(), "person")) & clear;
  return {static_cast<double>(cv::countNonZero(found & person)),
          static_cast<double>(cv::countNonZero(found | person))};
}

Options stride16(const std::string& model, ResultKind result, const std::string& classes) {
  Options options;
  options.network = {.model = shared_data() / "models" / model,
                     .width = 513,
                     .height = 385,
                     .scale = {1.0 / 128},
                     .mean = {128}};
  options.rule.result = result;
  options.cells = CellAlignment::kCorners;
  options.classes = {classes};
  return options;
}

/// Over both photos together.
double total_iou(const Options& options) {
  OpenCvDnnSegmenter segmenter(options, {.threads = 2});
  Overlap total;
  for (const std::string& photo : kPhotos) {
    const Overlap overlap = person_overlap(segmenter, photo);
    total.both += overlap.both;
    total.any += overlap.any;
  }
  return total.iou();
}

class Photos : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(shared_data() / "photos" / (kPhotos[0] + ".png")) ||
        !fs::exists(shared_data() / "models"))
      GTEST_SKIP() << "no photos and models in " << shared_data();
  }
};

TEST_F(Photos, ShippedNetwork) {
  Options options;
  options.network.model = shipped_model();
  OpenCvDnnSegmenter segmenter(options, {});
  EXPECT_NEAR(person_overlap(segmenter, kPhotos[0]).iou(), 0.82, kTolerance);
  EXPECT_NEAR(person_overlap(segmenter, kPhotos[1]).iou(), 0.75, kTolerance);
}

TEST_F(Photos, RefinementHelpsTheShippedNetwork) {
  Options options;
  options.network.model = shipped_model();
  const double plain = total_iou(options);
  options.refinement.radius = 8;
  EXPECT_GT(total_iou(options), plain + 0.02);
}

TEST_F(Photos, TheShippedNetworkIsAsGoodInAMirror) {
  Options options;
  options.network.model = shipped_model();
  options.rule.threshold = 0.45;
  options.refinement.radius = 8;
  options.mirror = true;
  for (const std::string& photo : kPhotos) {
    OpenCvDnnSegmenter segmenter(options, {});
    const double as_is = person_overlap(segmenter, photo).iou();
    const double in_mirror = person_overlap(segmenter, photo).iou();
    EXPECT_GT(in_mirror, as_is - kTolerance);
  }
}

TEST_F(Photos, PersonNetwork) {
  Options options;  // as configs/segmenters/person.yaml has them
  options.network = {.model = shipped_model().replace_filename("person_320x256.onnx"),
                     .width = 320,
                     .height = 256,
                     .scale = {1.0 / 128},
                     .mean = {128}};
  options.rule.result = ResultKind::kLogit;
  options.rule.margin = -0.25;
  EXPECT_NEAR(total_iou(options), 0.798, kTolerance);
  options.rule.margin = -0.75;
  EXPECT_NEAR(total_iou(options), 0.775, kTolerance);
}

TEST_F(Photos, SquareSelfieNetwork) {
  Options options;
  options.network.model = shared_data() / "models/selfie_segmentation.onnx";
  options.network.width = options.network.height = 256;
  OpenCvDnnSegmenter segmenter(options, {});
  EXPECT_NEAR(person_overlap(segmenter, kPhotos[0]).iou(), 0.75, kTolerance);
  EXPECT_NEAR(person_overlap(segmenter, kPhotos[1]).iou(), 0.78, kTolerance);
}

TEST_F(Photos, DeepLab) {
  EXPECT_NEAR(total_iou(stride16("deeplabv3_mnv2_voc21.onnx", ResultKind::kClassLogits, "voc21")),
              0.863, kTolerance);
}

TEST_F(Photos, SmallDeepLab) {
  EXPECT_NEAR(
      total_iou(stride16("deeplabv3_mnv2_dm05_voc21.onnx", ResultKind::kClassLogits, "voc21")),
      0.836, kTolerance);
}

TEST_F(Photos, BodyPix) {
  Options options = stride16("bodypix_mnv1_075_person.onnx", ResultKind::kLogit, "person");
  options.network.output = "segments";
  EXPECT_NEAR(total_iou(options), 0.873, kTolerance);
}

// Boxes without depth are ellipses: only that both people are found counts.
TEST_F(Photos, YoloFastest) {
  Options options;
  options.network.model = shared_data() / "models/yolo-fastest-1.1-xl.weights";
  options.network.config = shared_data() / "models/yolo-fastest-1.1-xl.cfg";
  options.network.width = options.network.height = 320;
  options.rule.result = ResultKind::kBoxes;
  options.classes = {"coco80"};
  EXPECT_GT(total_iou(options), 0.5);
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
