// Frames, labels, moving points and weights as a plugin written carelessly would give them: each is
// refused, with what is wrong and what to do.
#include "stillpoint/runtime/perception_results.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <opencv2/core.hpp>

#include "wrong_results.hpp"

namespace stillpoint {
namespace {

using ::testing::HasSubstr;
constexpr std::size_t kClasses = 3;

struct FrameFault {
  const char* name;
  std::function<void(Frame&)> spoil;
  const char* message;
};

class WrongFrame : public ::testing::TestWithParam<FrameFault> {};

TEST_P(WrongFrame, IsRefused) {
  const Frame previous = right_frame(6);
  Frame frame = right_frame(7);
  ASSERT_EQ(message_of([&] { check_frame(frame, 7, &previous); }), "");
  GetParam().spoil(frame);
  EXPECT_THAT(message_of([&] { check_frame(frame, 7, &previous); }), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    PerceptionResults, WrongFrame,
    ::testing::Values(
        FrameFault{"Index", [](Frame& f) { f.index = 9; }, "has index 9; indices count from 0"},
        FrameFault{"NanFocalLength",
                   [](Frame& f) {
                     f.camera = std::make_shared<Camera>(Camera{4, 3, kNan});
                   },
                   "the camera of the frame has impossible values; focal lengths lie"},
        FrameFault{"NoNoise",
                   [](Frame& f) {
                     f.camera = std::make_shared<Camera>(
                         Camera{.width = 4, .height = 3, .surface_noise = 0});
                   },
                   "the camera of the frame has impossible values; focal lengths lie"},
        FrameFault{"NanTime", [](Frame& f) { f.time = kNan; }, "time of the frame is not finite"},
        FrameFault{"Backwards", [](Frame& f) { f.time = 10.5; }, "0.500000 s older than the one"},
        FrameFault{"NoImage", [](Frame& f) { f.gray.release(); }, "the frame has no image"},
        FrameFault{"NoDepth", [](Frame& f) { f.depth.release(); }, "images of a frame differ"},
        FrameFault{"DepthType", [](Frame& f) { f.depth = cv::Mat(kSize, CV_16UC1, 1.0); },
                   "the depth image is of CV_16UC1; it must be of CV_32FC1"},
        FrameFault{"ColourType", [](Frame& f) { f.bgr = cv::Mat(kSize, CV_8UC4); },
                   "the colour image is of CV_8UC4"},
        FrameFault{"GreyType", [](Frame& f) { f.gray = cv::Mat(kSize, CV_16UC1, 1.0); },
                   "the grey image is of CV_16UC1; it must be of CV_8UC1"},
        FrameFault{"NoCamera", [](Frame& f) { f.camera = nullptr; }, "the frame has no camera"},
        FrameFault{"OtherCamera", [](Frame& f) { f.camera = std::make_shared<const Camera>(); },
                   "the images have 4 x 3 pixels, the camera 640 x 480"},
        FrameFault{"OtherSize",
                   [](Frame& f) {
                     f.camera = std::make_shared<const Camera>(Camera{.width = 2, .height = 2});
                     f.bgr = cv::Mat(2, 2, CV_8UC3);
                     f.gray = cv::Mat(2, 2, CV_8UC1);
                     f.depth = cv::Mat(2, 2, CV_32FC1);
                   },
                   "another size than those before"}),
    [](const auto& test) { return test.param.name; });

Segmentation right_labels() {
  Segmentation labels{.labels = cv::Mat::zeros(kSize, CV_8UC1),
                      .instances = cv::Mat::zeros(kSize, CV_8UC1)};
  labels.labels(cv::Rect(1, 1, 2, 1)).setTo(2);
  labels.instances(cv::Rect(1, 1, 2, 1)).setTo(1);
  labels.objects = {{.label = 2, .box = {1, 1, 2, 1}, .pixels = 2}};
  return labels;
}

struct LabelFault {
  const char* name;
  std::function<void(Segmentation&)> spoil;
  const char* message;
};

class WrongLabels : public ::testing::TestWithParam<LabelFault> {};

TEST_P(WrongLabels, AreRefused) {
  Segmentation labels = right_labels();
  ASSERT_EQ(message_of([&] { check_segmentation(labels, right_frame(), kClasses); }), "");
  GetParam().spoil(labels);
  EXPECT_THAT(message_of([&] { check_segmentation(labels, right_frame(), kClasses); }),
              HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    PerceptionResults, WrongLabels,
    ::testing::Values(
        LabelFault{"Size", [](Segmentation& s) { s.labels = cv::Mat::zeros(3, 3, CV_8UC1); },
                   "the labels have 3 x 3 pixels, but the frame has 4 x 3"},
        LabelFault{"Type", [](Segmentation& s) { s.labels = cv::Mat::zeros(kSize, CV_32SC1); },
                   "the labels are of CV_32SC1, not of CV_8UC1; give one byte per pixel"},
        LabelFault{"Class", [](Segmentation& s) { s.labels.at<std::uint8_t>(0) = 3; },
                   "a pixel has label 3, but there are 3 classes"},
        LabelFault{"Pixels", [](Segmentation& s) { s.objects[0].pixels = 0; },
                   "all objects have 0 pixels, but there are instances"},
        LabelFault{"NegativePixels", [](Segmentation& s) { s.objects[0].pixels = -2; },
                   "an object has -2 pixels"},
        LabelFault{"Score", [](Segmentation& s) { s.objects[0].score = 1.5F; }, "a score of 1.5"},
        LabelFault{"ScoreNan", [](Segmentation& s) { s.objects[0].score = kFloatNan; },
                   "a score of nan"},
        LabelFault{"Instance", [](Segmentation& s) { s.instances.at<std::uint8_t>(0) = 2; },
                   "belongs to object 2 of 1"},
        LabelFault{"InstanceSize", [](Segmentation& s) { s.instances = cv::Mat(2, 2, CV_8UC1); },
                   "the instances have 2 x 2 pixels, but the frame has 4 x 3"},
        LabelFault{"InstanceType", [](Segmentation& s) { s.instances = cv::Mat(kSize, CV_16UC1); },
                   "the instances are of CV_16UC1, not of CV_8UC1"},
        LabelFault{"Object", [](Segmentation& s) { s.objects[0].label = 3; },
                   "an object has label 3 of 3 classes"},
        LabelFault{"Background", [](Segmentation& s) { s.objects[0].label = 0; },
                   "an object has label 0"},
        LabelFault{"Box", [](Segmentation& s) { s.objects[0].box.x = 3; },
                   "the box of an object is not in the image"},
        LabelFault{"Frame", [](Segmentation& s) { s.frame = 6; },
                   "Segmentation::frame is 6 for frame 0; set it to Frame::index"}),
    [](const auto& test) { return test.param.name; });

TEST(PerceptionResults, LabelsThatAreNotKnownAreRight) {
  EXPECT_EQ(message_of([] { check_segmentation({}, right_frame(7), 0); }), "");
}

TEST(PerceptionResults, WrongWeightsAreRefused) {
  const Segmentation labels = right_labels();
  const auto message = [&](const StaticWeights& weights) {
    return message_of([&] { check_weights(weights, labels, kSize); });
  };
  EXPECT_EQ(message({}), "");
  EXPECT_EQ(message({.track = cv::Mat(kSize, CV_8UC1), .object_moves = {true}}), "");
  EXPECT_THAT(message({.track = cv::Mat(2, 4, CV_8UC1)}), HasSubstr("the weights have 4 x 2"));
  EXPECT_THAT(message({.map = cv::Mat(kSize, CV_32FC1)}), HasSubstr("the weights are of CV_32FC1"));
  EXPECT_THAT(message({.object_moves = {true, false}}),
              HasSubstr("2 objects are judged, but there are 1"));
}

TEST(PerceptionResults, WrongMotionAndEvidenceAreRefused) {
  MovingPoints moving{.points = {{.previous = {1, 2}, .current = {1, 2}}}, .reliable = true};
  const auto message = [&] { return message_of([&] { check_moving_points(moving, kSize); }); };
  EXPECT_EQ(message(), "");
  moving.points[0].previous = {-1, 2};
  EXPECT_THAT(message(), HasSubstr("a point at -1, 2 is not in the image; points are in pixels"));
  moving.points[0].previous = {3, 2.75F};
  EXPECT_THAT(message(), HasSubstr("a point at 3, 2.75 is not in the image"));
  moving.points[0].current.y = static_cast<float>(kNan);
  EXPECT_THAT(message(), HasSubstr("a point is not finite"));
  moving = {.camera_motion = Pose(Eigen::Scaling(2.0))};
  EXPECT_THAT(message(), HasSubstr("no rigid motion"));
}

TEST(PerceptionResults, WrongEvidenceIsRefused) {
  const auto message = [](cv::Size cells, int type = CV_32FC1, cv::Size frame = {251, 187}) {
    return message_of([&] { check_evidence({cv::Mat(cells, type)}, frame); });
  };
  EXPECT_EQ(message({}), "");
  EXPECT_EQ(message({251, 187}), "");
  EXPECT_EQ(message({62, 46}), "");
  EXPECT_EQ(message({63, 47}), "");
  EXPECT_EQ(message({1, 1}, CV_32FC1, {4, 3}), "");
  EXPECT_THAT(message({62, 46}, CV_64FC1), HasSubstr("the evidence is of CV_64FC1"));
  EXPECT_THAT(message({62, 62}), HasSubstr("the evidence has 62 x 62 cells, which do not cover "
                                           "the frame of 251 x 187 pixels as squares; give one"));
  EXPECT_THAT(message({187, 251}), HasSubstr("do not cover"));
}

TEST(PerceptionResults, DepthInMillimetresIsRefused) {
  Frame frame = right_frame();
  frame.depth.setTo(1530);
  EXPECT_THAT(message_of([&] { check_frame(frame, 0, nullptr); }),
              HasSubstr("half of the first depth image lies beyond 1530 m; give depth in metres;"));
  frame.depth.setTo(0);
  EXPECT_EQ(message_of([&] { check_frame(frame, 0, nullptr); }), "");
}

}  // namespace
}  // namespace stillpoint
