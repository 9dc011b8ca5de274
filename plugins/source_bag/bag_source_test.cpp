#include "source_bag/bag_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillpoint/support/image_codec.hpp"
#include "support/bag_writer.hpp"
#include "support/error_text.hpp"
#include "support/recording_writer.hpp"
#include "support/source_frames.hpp"

namespace stillpoint::source_bag {
namespace {

using ::testing::AllOf;
using testing::BagBytes;
using testing::BagStyle;
using testing::BagWriter;
using testing::camera_info_message;
using testing::color_image;
using testing::compressed_message;
using testing::depth_image;
using ::testing::ElementsAre;
using testing::error_text;
using testing::frames_of;
using ::testing::HasSubstr;
using testing::image_message;
using ::testing::IsEmpty;
using testing::kImageHeight;
using testing::kImageWidth;
using testing::TemporaryFolder;
using testing::TestCameraInfo;
using testing::transforms_message;

constexpr std::int64_t kStart = 1'305'031'102'175'304'000;  // ns
constexpr std::int64_t kInterval = 33'333'000;              // ns
constexpr const char* kColor = "/camera/color/image_raw";
constexpr const char* kDepth = "/camera/depth_registered/image_raw";
constexpr const char* kUnregistered = "/camera/depth/image_raw";

BagBytes encoded(const cv::Mat& image, const std::string& ending = ".png") {
  return encode_image(ending, image);
}

class BagSourceTest : public ::testing::TestWithParam<BagStyle> {
 protected:
  explicit BagSourceTest(const BagStyle& style)
      : file_(folder_.path() / ("a." + style.format)),
        writer_(testing::make_bag_writer(file_, style)),
        serialisation_(writer_->serialisation()) {}
  BagSourceTest() : BagSourceTest(GetParam()) {}

  void add(const std::string& topic, const std::string& type, std::int64_t time,
           const BagBytes& message) {
    writer_->add(topic, type, time + 5'000'000, message);  // it arrives later
  }
  void color(int i, const std::string& frame = "color_frame") {
    add(kColor, "sensor_msgs/Image", stamp(i),
        image_message(serialisation_, stamp(i), frame, color_image(i), "bgr8"));
  }
  void depth(int i, const std::string& frame = "color_frame", const char* topic = kDepth) {
    add(topic, "sensor_msgs/Image", stamp(i),
        image_message(serialisation_, stamp(i) + 4'000'000, frame, depth_image(1000 + i), "16UC1"));
  }
  void info(const TestCameraInfo& camera = {}) {
    add("/camera/color/camera_info", "sensor_msgs/CameraInfo", stamp(0),
        camera_info_message(serialisation_, camera));
  }
  void depth_info() {
    add("/camera/depth/camera_info", "sensor_msgs/CameraInfo", stamp(0),
        camera_info_message(serialisation_, {.frame = "depth_frame"}));
  }
  /// The depth camera is 10 cm to the left of the colour camera.
  void tf() {
    const Pose color_from_depth(Eigen::Translation3d(0.1, 0, 0));
    add("/tf_static", "tf2_msgs/TFMessage", stamp(0),
        transforms_message(serialisation_, {{"color_frame", "depth_frame", color_from_depth}}));
  }
  void write(int count) {
    info();
    for (int i = 0; i < count; ++i) {
      color(i);
      depth(i);
    }
  }
  BagSource open(BagSource::Options options = {}, const StageContext& context = {}) {
    if (writer_) writer_->finish();
    writer_.reset();
    options.path = file_.string();
    return BagSource(options, context);
  }
  static std::int64_t stamp(int i) { return kStart + kInterval * i; }
  TemporaryFolder folder_;
  std::filesystem::path file_;
  std::unique_ptr<BagWriter> writer_;
  bag::Serialisation serialisation_;
};

TEST_P(BagSourceTest, GivesFramesWithTheCameraOfTheBag) {
  write(5);
  BagSource source = open();
  EXPECT_EQ(source.size(), 5U);
  const auto frames = frames_of(source);
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[3].index, 3U);
  EXPECT_DOUBLE_EQ(frames[3].time, 1305031102.275303);  // of the exposure
  EXPECT_EQ(frames[3].bgr.at<cv::Vec3b>(5, 7), cv::Vec3b(3, 100, 200));
  EXPECT_FLOAT_EQ(frames[3].depth.at<float>(5, 7), 1.003F);  // millimetres
  EXPECT_EQ(frames[3].camera->fx, 50);
  EXPECT_EQ(frames[3].camera->width, kImageWidth);
  EXPECT_TRUE(source.report().warnings.empty());
  EXPECT_FALSE(source.next().has_value());
}

TEST_P(BagSourceTest, ReadsATruncatedBagAsFarAsItGoes) {
  write(20);
  writer_->finish();
  writer_.reset();
  testing::truncate_file(file_, 0.6);
  BagSource source = open();
  const auto frames = frames_of(source);
  EXPECT_GE(frames.size(), 8U);
  EXPECT_LE(frames.size(), 13U);
  EXPECT_FALSE(source.report().warnings.empty());
}

INSTANTIATE_TEST_SUITE_P(Formats, BagSourceTest,
                         ::testing::Values(BagStyle{"bag", "lz4"}, BagStyle{"mcap", "zstd"},
                                           BagStyle{"db3", "none"}),
                         [](const auto& parameter) { return parameter.param.format; });

class OneBagSourceTest : public BagSourceTest {
 protected:
  OneBagSourceTest() : BagSourceTest(BagStyle{"mcap", "none"}) {}
};

TEST_F(OneBagSourceTest, TakesAnotherCameraAndItsDepthFactor) {
  write(2);
  StageContext context;
  context.camera = CameraModel{
      .name = "mine", .width = kImageWidth, .height = kImageHeight, .fx = 60, .depth_factor = 2000};
  BagSource source = open({}, context);
  const auto frame = source.next();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->camera->fx, 60);
  EXPECT_FLOAT_EQ(frame->depth.at<float>(5, 7), 0.5F);
}

/// As a user's files have it who has run folders until now.
StageContext context_with_depth_factor(double factor) {
  StageContext context;
  context.camera = CameraModel{.name = "mine",
                               .width = kImageWidth,
                               .height = kImageHeight,
                               .fx = 60,
                               .depth_factor = factor};
  return context;
}

TEST_F(OneBagSourceTest, TellsThatACameraFileHasAnotherUnitThanTheBag) {
  write(1);
  EXPECT_THAT(open({}, context_with_depth_factor(5000)).report().warnings,
              ElementsAre("16-bit depth of ROS is in millimetres, but the camera file has "
                          "depth_factor 5000: set it to 1000, or source.depth_factor if these "
                          "images differ"));
  EXPECT_THAT(open({.depth_factor = 5000}, context_with_depth_factor(5000)).report().warnings,
              IsEmpty());
  EXPECT_THAT(open({}, context_with_depth_factor(1000)).report().warnings, IsEmpty());
}

TEST_F(OneBagSourceTest, SaysNothingOfTheUnitOfMetres) {
  info();
  color(0);
  cv::Mat metres;
  depth_image(1000).convertTo(metres, CV_32F, 0.001);
  add(kDepth, "sensor_msgs/Image", stamp(0),
      image_message(serialisation_, stamp(0), "color_frame", metres, "32FC1"));
  EXPECT_THAT(open({}, context_with_depth_factor(5000)).report().warnings, IsEmpty());
}

TEST_F(OneBagSourceTest, TakesAnotherDepthFactor) {
  write(1);
  BagSource source = open({.depth_factor = 500});
  EXPECT_FLOAT_EQ(source.next()->depth.at<float>(5, 7), 2.0F);
}

TEST_F(OneBagSourceTest, ReadsCompressedImages) {
  info();
  const auto compressed = [&](const char* topic, int i, const char* format, const BagBytes& file) {
    add(topic, "sensor_msgs/CompressedImage", stamp(i),
        compressed_message(serialisation_, stamp(i), "color_frame", format, file));
  };
  compressed("/camera/color/image_raw/compressed", 0, "rgb8; jpeg compressed bgr8",
             encoded(color_image(90), ".jpg"));
  compressed("/camera/color/image_raw/compressed", 1, "rgb8; png compressed bgr8",
             encoded(color_image(91)));
  for (int i = 0; i < 2; ++i) {
    BagBytes depth_file(12, 0);
    const BagBytes png = encoded(depth_image(2000 + i));
    depth_file.insert(depth_file.end(), png.begin(), png.end());
    compressed("/camera/depth/image_raw/compressedDepth", i, "16UC1; compressedDepth png",
               depth_file);
  }
  BagSource source = open();
  const auto frames = frames_of(source);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_NEAR(frames[0].bgr.at<cv::Vec3b>(5, 7)[0], 90, 3);
  EXPECT_EQ(frames[1].bgr.at<cv::Vec3b>(5, 7), cv::Vec3b(91, 100, 200));
  EXPECT_FLOAT_EQ(frames[1].depth.at<float>(5, 7), 2.001F);
}

TEST_F(OneBagSourceTest, SkipsImagesThatCannotBeUsed) {
  info();
  for (int i = 0; i < 5; ++i) {
    if (i == 2)
      add(kColor, "sensor_msgs/Image", stamp(i),
          image_message(serialisation_, stamp(i), "color_frame", color_image(i), "bgr99"));
    else
      color(i);
    depth(i);
  }
  BagSource source = open();
  EXPECT_EQ(frames_of(source).size(), 4U);
  EXPECT_EQ(source.report().skipped, 1U);
  EXPECT_THAT(source.report().warnings,
              ElementsAre(AllOf(HasSubstr("skipped: /camera/color/image_raw at 1305031102.2"),
                                HasSubstr("cannot have the encoding 'bgr99'"))));
}

TEST_F(OneBagSourceTest, LeavesOutRepeatedStamps) {
  write(3);
  color(2);
  BagSource source = open();
  EXPECT_EQ(frames_of(source).size(), 3U);
  EXPECT_THAT(source.report().warnings,
              ElementsAre(HasSubstr("1 message is left out for a repeated")));
}

// The clock of the camera's driver is set back by two seconds, and a little later by 0.2 s.
TEST_F(OneBagSourceTest, SaysThatStampsGoBack) {
  info();
  const std::vector<int> stamps_in_order_of_arrival = {100, 101, 40, 41, 35};
  for (std::size_t k = 0; k < stamps_in_order_of_arrival.size(); ++k) {
    const int i = stamps_in_order_of_arrival[k];
    const std::int64_t arrival = stamp(static_cast<int>(k));
    add(kColor, "sensor_msgs/Image", arrival,
        image_message(serialisation_, stamp(i), "color_frame", color_image(i), "bgr8"));
    add(kDepth, "sensor_msgs/Image", arrival,
        image_message(serialisation_, stamp(i), "color_frame", depth_image(1000 + i), "16UC1"));
  }
  BagSource source = open();
  std::vector<int> order;
  for (const Frame& frame : frames_of(source)) order.push_back(frame.bgr.at<cv::Vec3b>(5, 7)[0]);
  EXPECT_EQ(order, (std::vector<int>{35, 40, 41, 100, 101}));
  const std::string text =
      ": the time stamps go back 1 time, by up to 2.0 s: images are used in order of their stamps";
  EXPECT_THAT(source.report().warnings, ElementsAre(kColor + text, kDepth + text));
}

TEST_F(OneBagSourceTest, RefusesDepthOfWhichNothingSaysWhereItIs) {
  info();
  color(0);
  depth(0, "depth_frame", kUnregistered);
  EXPECT_THAT(error_text(Fault::kUsage, [&] { open(); }),
              AllOf(HasSubstr("is in the frame 'depth_frame'"),
                    HasSubstr("the bag has no CameraInfo of /camera/depth/image_raw"),
                    HasSubstr("source.depth_info_topic"), HasSubstr("source.registered=true")));
  EXPECT_EQ(open({.registered = true}).size(), 1U);
}

TEST_F(OneBagSourceTest, RefusesDepthThatTfDoesNotConnect) {
  info();
  depth_info();
  color(0);
  depth(0, "depth_frame", kUnregistered);
  EXPECT_THAT(error_text(Fault::kUsage, [&] { open(); }),
              AllOf(HasSubstr("cannot be registered to the colour images"),
                    HasSubstr("tf does not say how 'depth_frame' lies to 'color_frame'"),
                    HasSubstr("/tf_static"), HasSubstr("source.registered=true")));
}

// A patch a metre away, seen by a camera 10 cm to the left of the colour camera: with a focal
// length of 50 px, it is 5 px farther right in the colour image.
TEST_F(OneBagSourceTest, RegistersDepthByTf) {
  info();
  depth_info();
  tf();
  color(0);
  cv::Mat patch = depth_image(0);
  patch(cv::Rect(20, 15, 10, 8)) = 1000;
  add(kUnregistered, "sensor_msgs/Image", stamp(0),
      image_message(serialisation_, stamp(0), "depth_frame", patch, "16UC1"));
  color(1);
  add(kUnregistered, "sensor_msgs/Image", stamp(1),
      image_message(serialisation_, stamp(1), "depth_frame", patch.rowRange(0, 20), "16UC1"));
  cv::Mat metres;
  patch.convertTo(metres, CV_32F, 0.001);
  color(2);
  add(kUnregistered, "sensor_msgs/Image", stamp(2),
      image_message(serialisation_, stamp(2), "depth_frame", metres, "32FC1"));
  BagSource source = open();
  const auto frames = frames_of(source);
  cv::Mat expected = cv::Mat::zeros(kImageHeight, kImageWidth, CV_32FC1);
  expected(cv::Rect(25, 15, 10, 8)) = 1;
  ASSERT_EQ(frames.size(), 2U);
  for (const Frame& frame : frames) {
    EXPECT_EQ(cv::norm(frame.depth, expected, cv::NORM_INF), 0);
    EXPECT_EQ(frame.bgr.size(), frame.depth.size());
  }
  EXPECT_THAT(source.report().warnings,
              ElementsAre(HasSubstr("the depth image has 64 x 20 pixels, but its camera")));
}

/// A patch of depth.
cv::Mat patch_at(int x, int y, int raw) {
  cv::Mat patch = depth_image(0);
  patch(cv::Rect(x, y, 10, 8)) = raw;
  return patch;
}

cv::Mat in_metres(const cv::Mat& raw, double factor) {
  cv::Mat metres;
  raw.convertTo(metres, CV_32F, 1 / factor);
  return metres;
}

// As of kinect2_bridge: colour as recorded, with one CameraInfo for raw and rectified images.
TEST_F(OneBagSourceTest, DoesNotUndistortRectifiedDepth) {
  const TestCameraInfo camera{.distortion = {0.3, 0, 0, 0, 0}, .rectified_fx = 50};  // that of K
  const cv::Mat patch = patch_at(52, 4, 1000);
  add("/kinect2/qhd/camera_info", "sensor_msgs/CameraInfo", stamp(0),
      camera_info_message(serialisation_, camera));
  add("/kinect2/qhd/image_color", "sensor_msgs/Image", stamp(0),
      image_message(serialisation_, stamp(0), "rgb", color_image(9), "bgr8"));
  add("/kinect2/qhd/image_depth_rect", "sensor_msgs/Image", stamp(0),
      image_message(serialisation_, stamp(0), "rgb", patch, "16UC1"));
  BagSource source = open();
  const auto frames = frames_of(source);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(cv::norm(frames[0].depth, in_metres(patch, 1000), cv::NORM_INF), 0);
  EXPECT_EQ(frames[0].bgr.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 0));  // not seen: it is undistorted
}

/// As realsense-viewer writes it: depth in 0.5 mm, 10 cm to the left of the colour camera.
class RealSenseBagSourceTest : public BagSourceTest {
 protected:
  RealSenseBagSourceTest() : BagSourceTest(BagStyle{"bag", "lz4"}) {
    add("/device_0/sensor_0/option/Depth Units/value", "std_msgs/Float32", stamp(0),
        testing::ByteWriter(serialisation_).number(0.0005F).bytes());
    for (const char* stream : {kColorStream, kDepthStream})
      add(std::string(stream) + "/info/camera_info", "sensor_msgs/CameraInfo", stamp(0),
          camera_info_message(serialisation_, {.frame = "", .rectified_fx = 0}));
    image(kColorStream, color_image(9), "bgr8");
    image(kDepthStream, patch_at(20, 15, 2000), "mono16");
  }
  void image(const std::string& stream, const cv::Mat& pixels, const std::string& encoding) {
    add(stream + "/image/data", "sensor_msgs/Image", stamp(0),
        image_message(serialisation_, stamp(0), "0", pixels, encoding));
  }
  /// Where the first stream of the device is in this one: without rotation.
  void transform(const std::string& stream, double x) {
    testing::ByteWriter writer(serialisation_);
    for (const double number : {x, 0., 0., 0., 0., 0., 1.}) writer.number(number);
    add(stream + "/tf/0", "geometry_msgs/Transform", stamp(0), writer.bytes());
  }
  static constexpr const char* kColorStream = "/device_0/sensor_1/Color_0";
  static constexpr const char* kDepthStream = "/device_0/sensor_0/Depth_0";
};

TEST_F(RealSenseBagSourceTest, RegistersDepthByTheTransformsOfTheSdk) {
  transform(kColorStream, 0.06);
  transform(kDepthStream, -0.04);
  BagSource source = open();
  const auto frames = frames_of(source);
  ASSERT_EQ(frames.size(), 1U);
  const cv::Mat expected = in_metres(patch_at(25, 15, 2000), 2000);
  EXPECT_EQ(cv::norm(frames[0].depth, expected, cv::NORM_INF), 0);
}

TEST_F(RealSenseBagSourceTest, RefusesDepthWithoutThem) {
  transform(kColorStream, 0.06);
  EXPECT_THAT(error_text(Fault::kUsage, [&] { open(); }),
              AllOf(HasSubstr("a recording of the RealSense SDK, whose depth is not registered"),
                    HasSubstr("align_depth"), HasSubstr("source.registered=true")));
  BagSource source = open({.registered = true});
  EXPECT_FLOAT_EQ(source.next()->depth.at<float>(16, 21), 1.0F);
}

TEST_F(OneBagSourceTest, AsksForACamera) {
  color(0);
  depth(0);
  EXPECT_THAT(error_text(Fault::kUsage, [&] { open(); }),
              AllOf(HasSubstr("has no CameraInfo"), HasSubstr("--camera")));
}

TEST_F(OneBagSourceTest, SaysWhenNothingPairs) {
  write(2);
  EXPECT_THAT(error_text(Fault::kData, [&] { open({.max_difference = 0.001}); }),
              AllOf(HasSubstr("within 0.001"), HasSubstr("change max_difference")));
  EXPECT_EQ(open({.max_difference = 0.001, .time_offset = -0.004}).size(), 2U);
}

}  // namespace
}  // namespace stillpoint::source_bag
