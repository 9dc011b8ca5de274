#include "bag/topic_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "bag/camera_model.hpp"
#include "bag/depth_extrinsics.hpp"
#include "support/bag_writer.hpp"
#include "support/error_text.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::bag {
namespace {

using stillpoint::testing::camera_info_message;
using stillpoint::testing::compressed_message;
using stillpoint::testing::error_text;
using stillpoint::testing::image_message;
using stillpoint::testing::make_bag_writer;
using stillpoint::testing::TemporaryFolder;
using stillpoint::testing::TestCameraInfo;
using ::testing::AllOf;
using ::testing::HasSubstr;

class TopicChoiceTest : public ::testing::Test {
 protected:
  void image(const std::string& topic, const std::string& frame, const std::string& encoding) {
    const int type = encoding == "16UC1" ? CV_16UC1 : encoding == "mono8" ? CV_8UC1 : CV_8UC3;
    add(topic, "sensor_msgs/Image",
        image_message(Serialisation::kRos1, 5, frame, cv::Mat::zeros(4, 4, type), encoding));
  }
  void compressed(const std::string& topic, const std::string& frame, const std::string& format) {
    add(topic, "sensor_msgs/CompressedImage",
        compressed_message(Serialisation::kRos1, 5, frame, format, {1}));
  }
  void info(const std::string& topic, const TestCameraInfo& camera = {}) {
    add(topic, "sensor_msgs/CameraInfo", camera_info_message(Serialisation::kRos1, camera));
  }
  BagReader& bag() {
    if (!bag_) {
      writer_->finish();
      bag_ = open_bag(file_);
    }
    return *bag_;
  }
  TopicChoice choose(const TopicNames& names = {}) { return choose_topics(bag(), names); }

  void add(const std::string& topic, const std::string& type, const std::vector<std::uint8_t>& m) {
    writer_->add(topic, type, 1'000'000'000 + ++time_, m);
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.bag";
  std::unique_ptr<stillpoint::testing::BagWriter> writer_ = make_bag_writer(file_, {});
  std::unique_ptr<BagReader> bag_;
  std::int64_t time_ = 0;
};

TEST_F(TopicChoiceTest, FindsThoseOfARealSense) {
  image("/camera/infra1/image_rect_raw", "camera_infra1_optical_frame", "mono8");
  image("/camera/depth/image_rect_raw", "camera_depth_optical_frame", "16UC1");
  image("/camera/aligned_depth_to_color/image_raw", "camera_color_optical_frame", "16UC1");
  image("/camera/color/image_raw", "camera_color_optical_frame", "rgb8");
  compressed("/camera/color/image_raw/compressed", "camera_color_optical_frame", "jpeg");
  info("/camera/depth/camera_info");
  info("/camera/color/camera_info");
  const TopicChoice choice = choose();
  EXPECT_EQ(choice.color.name, "/camera/color/image_raw");
  EXPECT_EQ(choice.depth.name, "/camera/aligned_depth_to_color/image_raw");
  EXPECT_EQ(bag().topics()[choice.color.info.value()].name, "/camera/color/camera_info");
  EXPECT_TRUE(choice.registered());
  EXPECT_FALSE(choice.color.rectified());
  const TopicChoice other = choose({.depth = "/camera/depth/image_rect_raw"});
  EXPECT_FALSE(other.registered());
  EXPECT_TRUE(other.depth.rectified());
  EXPECT_EQ(bag().topics()[other.depth.info.value()].name, "/camera/depth/camera_info");
}

TEST_F(TopicChoiceTest, FindsThoseOfTheTumBenchmark) {
  image("/camera/rgb/image_color", "/openni_rgb_optical_frame", "rgb8");
  image("/camera/depth/image", "openni_rgb_optical_frame", "16UC1");
  info("/camera/rgb/camera_info");
  info("/camera/depth/camera_info");
  const TopicChoice choice = choose();
  EXPECT_EQ(choice.depth.name, "/camera/depth/image");
  EXPECT_EQ(bag().topics()[choice.color.info.value()].name, "/camera/rgb/camera_info");
  EXPECT_TRUE(choice.registered());
}

TEST_F(TopicChoiceTest, FindsCompressedOnes) {
  compressed("/camera/rgb/image_rect_color/compressed", "rgb", "rgb8; jpeg compressed bgr8");
  compressed("/camera/depth_registered/image_raw/compressedDepth", "rgb", "16UC1; compressedDepth");
  info("/camera/rgb/camera_info");
  const TopicChoice choice = choose();
  EXPECT_EQ(choice.depth.name, "/camera/depth_registered/image_raw/compressedDepth");
  EXPECT_TRUE(choice.color.info.has_value());
  EXPECT_TRUE(choice.color.rectified());
}

TEST_F(TopicChoiceTest, TakesGrayImagesWhereThereIsNoColour) {
  image("/mono/image", "m", "mono8");
  image("/depth/image", "m", "16UC1");
  EXPECT_EQ(choose().color.name, "/mono/image");
}

TEST_F(TopicChoiceTest, TakesThoseThatAreNamed) {
  for (const char* name : {"front", "back"}) {
    image(std::string("/") + name + "/color/image_raw", name, "rgb8");
    image(std::string("/") + name + "/depth/image_raw", name, "16UC1");
  }
  EXPECT_THAT(error_text(Fault::kUsage, [&] { choose(); }),
              AllOf(HasSubstr("several topics may be the color_topic"),
                    HasSubstr("/back/color/image_raw (rgb8), /front/color/image_raw (rgb8)"),
                    HasSubstr("--set source.color_topic=NAME for run, --color-topic NAME for "
                              "inspect")));
  EXPECT_EQ(choose({.color = "/back/color/image_raw"}).depth.name, "/back/depth/image_raw");
  EXPECT_EQ(choose({.color = "front/color/image_raw"}).depth.name, "/front/depth/image_raw");
  EXPECT_THAT(error_text(Fault::kUsage, [&] { choose({.color = "/back/color/image_rw"}); }),
              HasSubstr("did you mean '/back/color/image_raw'?"));
  EXPECT_THAT(error_text(Fault::kUsage,
                         [&] { choose({.color = "/back/color/image_raw", .info = "/info"}); }),
              HasSubstr("there is no topic of camera infos '/info'"));
}

TEST_F(TopicChoiceTest, SaysWhatIsMissing) {
  image("/color/image", "c", "rgb8");
  EXPECT_THAT(error_text(Fault::kUsage, [&] { choose(); }),
              AllOf(HasSubstr("there is no topic with depth images"),
                    HasSubstr("topics with images: /color/image (rgb8)")));
}

TEST_F(TopicChoiceTest, DepthOfAnotherFrameIsNotRegistered) {
  image("/color/image", "c", "rgb8");
  image("/depth/image", "d", "16UC1");
  EXPECT_FALSE(choose().registered());
  EXPECT_THAT(
      error_text(Fault::kUsage, [&] { camera_in_bag(bag(), choose().color); }),
      AllOf(HasSubstr("has no CameraInfo of /color/image"),
            HasSubstr("--set source.info_topic=NAME for run, --info-topic NAME for inspect"),
            HasSubstr("--camera")));
}

// As of a driver that stamps all its cameras with one frame.
TEST_F(TopicChoiceTest, DepthOfAnotherCameraIsNotRegisteredWhateverItsFrame) {
  image("/color/image", "camera", "rgb8");
  image("/depth/image", "camera", "16UC1");
  info("/color/camera_info");
  info("/depth/camera_info", {.fx = 60});
  const TopicChoice choice = choose();
  EXPECT_FALSE(choice.registered());
  EXPECT_THAT(error_text(Fault::kUsage, [&] { depth_extrinsics(bag(), choice); }),
              AllOf(HasSubstr("both have the same frame, but their CameraInfo are of different "
                              "cameras"),
                    HasSubstr("source.registered=true")));
}

TEST_F(TopicChoiceTest, AFrameWithoutANameIsNone) {
  image("/color/image", "", "rgb8");
  image("/depth/image", "", "16UC1");
  info("/color/camera_info");
  info("/depth/camera_info");
  const TopicChoice choice = choose();
  EXPECT_FALSE(choice.registered());
  EXPECT_THAT(error_text(Fault::kUsage, [&] { depth_extrinsics(bag(), choice); }),
              HasSubstr("the frame '' does not say where a camera is"));
}

TEST_F(TopicChoiceTest, TheCameraIsThatOfTheImages) {
  image("/color/image_raw", "c", "rgb8");
  image("/color/image_rect_color", "c", "rgb8");
  image("/depth/image", "c", "16UC1");
  info("/color/camera_info", {.distortion = {0.1, -0.2, 0, 0, 0}});
  const CameraModel raw = camera_in_bag(bag(), choose().color);
  EXPECT_EQ(raw.name, "/color/camera_info");
  EXPECT_EQ(raw.width, 64);
  EXPECT_EQ(raw.fx, 50);
  EXPECT_EQ(raw.distortion, (std::vector<double>{0.1, -0.2, 0, 0}));
  EXPECT_EQ(raw.depth_factor, 1000);
  const CameraModel rectified =
      camera_in_bag(bag(), choose({.color = "/color/image_rect_color"}).color);
  EXPECT_EQ(rectified.fx, 45);
  EXPECT_TRUE(rectified.distortion.empty());
}

// As of kinect2_bridge: P of the one CameraInfo is for the rectified images.
TEST_F(TopicChoiceTest, TheCameraOfRectifiedDepthIsP) {
  image("/qhd/image_color", "rgb", "rgb8");
  image("/qhd/image_depth_rect", "rgb", "16UC1");
  info("/qhd/camera_info", {.distortion = {0.1, -0.2, 0, 0, 0}});
  const TopicChoice choice = choose();
  EXPECT_TRUE(choice.registered());
  const CameraModel color = camera_in_bag(bag(), choice.color);
  const CameraModel depth = rectified_camera(choice, color);
  EXPECT_EQ(depth.fx, 45);
  EXPECT_TRUE(depth.distortion.empty());
  CameraModel of_another_size = color;
  of_another_size.width = 1000;
  EXPECT_EQ(rectified_camera(choice, of_another_size).fx, 50);
}

TEST_F(TopicChoiceTest, TheCameraIsThatOfTheFirstMessageThatIsWhole) {
  image("/color/image", "c", "rgb8");
  image("/depth/image", "c", "16UC1");
  add("/color/camera_info", "sensor_msgs/CameraInfo", {1, 2, 3});
  info("/color/camera_info");
  EXPECT_EQ(camera_in_bag(bag(), choose().color).fx, 50);
}

TEST_F(TopicChoiceTest, RefusesCamerasItDoesNotHave) {
  const auto model = [](const CameraInfoMessage& message) { camera_model(message, false, "/i"); };
  CameraInfoMessage camera{.width = 64, .height = 48, .model = "rational_polynomial"};
  camera.intrinsics = {50, 0, 32, 0, 51, 24, 0, 0, 1};
  camera.distortion = {0.1, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_NO_THROW(model(camera));
  camera.distortion.back() = 0.3;
  EXPECT_THAT(error_text(Fault::kData, [&] { model(camera); }), HasSubstr("with 8 coefficients"));
  camera.distortion = {0.1, 0, 0, 0};
  camera.model = "equidistant";
  EXPECT_THAT(error_text(Fault::kData, [&] { model(camera); }), HasSubstr("rectify"));
  camera.distortion.clear();
  camera.width = 0;
  EXPECT_THAT(error_text(Fault::kData, [&] { model(camera); }), HasSubstr("width"));
  camera.intrinsics = {};
  EXPECT_THAT(error_text(Fault::kData, [&] { model(camera); }), HasSubstr("is not calibrated"));
}

}  // namespace
}  // namespace stillpoint::bag
