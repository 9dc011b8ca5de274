#include "bag/realsense_recording.hpp"

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

using stillpoint::testing::BagBytes;
using stillpoint::testing::ByteWriter;
using stillpoint::testing::camera_info_message;
using stillpoint::testing::error_text;
using stillpoint::testing::image_message;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr auto kRos1 = Serialisation::kRos1;

const Pose kColorFromGroup(Eigen::Translation3d(0.015, 0.001, 0) *
                           Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));
const Pose kDepthFromGroup(Eigen::Translation3d(-0.05, 0, 0.002));

/// What realsense-viewer writes of a D435.
class RealSenseRecording : public ::testing::Test {
 protected:
  RealSenseRecording() {
    image("/device_0/sensor_0/Depth_0", CV_16UC1, "mono16");
    image("/device_0/sensor_0/Infrared_1", CV_8UC1, "8UC1");
    image("/device_0/sensor_1/Color_0", CV_8UC3, "rgb8");
    info("/device_0/sensor_0/Depth_0", 40);
    info("/device_0/sensor_1/Color_0", 50);
  }
  void add(const std::string& topic, const std::string& type, const BagBytes& message) {
    writer_->add(topic, type, ++time_, message);
  }
  void image(const std::string& stream, int type, const std::string& encoding) {
    add(stream + "/image/data", "sensor_msgs/Image",
        image_message(kRos1, 5, "0", cv::Mat::zeros(4, 4, type), encoding));
  }
  void info(const std::string& stream, double fx) {
    add(stream + "/info/camera_info", "sensor_msgs/CameraInfo",
        camera_info_message(kRos1, {.frame = "",
                                    .model = "Brown Conrady",
                                    .distortion = {0.1, 0, 0, 0, 0},
                                    .fx = fx,
                                    .rectified_fx = 0}));
  }
  void transform(const std::string& topic, const Pose& pose) {
    ByteWriter writer(kRos1);
    for (const double t : pose.translation()) writer.number(t);
    const Eigen::Quaterniond rotation(pose.linear());
    for (const double q : rotation.coeffs()) writer.number(q);  // x, y, z, w
    add(topic, "geometry_msgs/Transform", writer.bytes());
  }
  void unit(float metres) {
    add("/device_0/sensor_0/option/Depth Units/value", "std_msgs/Float32",
        ByteWriter(kRos1).number(metres).bytes());
  }
  BagReader& bag() {
    if (!bag_) {
      writer_->finish();
      bag_ = open_bag(file_);
    }
    return *bag_;
  }

 private:
  const stillpoint::testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "a.bag";
  const std::unique_ptr<stillpoint::testing::BagWriter> writer_ =
      stillpoint::testing::make_bag_writer(file_, {"bag", "lz4"});
  std::unique_ptr<BagReader> bag_;
  std::int64_t time_ = 0;
};

TEST_F(RealSenseRecording, HasStreamsAndTheirCameras) {
  const TopicChoice choice = choose_topics(bag(), {});
  EXPECT_EQ(choice.color.name, "/device_0/sensor_1/Color_0/image/data");
  EXPECT_EQ(choice.depth.name, "/device_0/sensor_0/Depth_0/image/data");
  EXPECT_FALSE(choice.registered());
  const CameraModel color = camera_in_bag(bag(), choice.color);
  EXPECT_EQ(color.fx, 50);
  EXPECT_EQ(color.distortion.at(0), 0.1);
  EXPECT_EQ(camera_in_bag(bag(), choice.depth).fx, 40);
}

TEST_F(RealSenseRecording, SaysWhereTheDepthCameraIs) {
  transform("/device_0/sensor_0/Depth_0/tf/0", kDepthFromGroup);
  transform("/device_0/sensor_1/Color_0/tf/0", kColorFromGroup);
  const DepthExtrinsics depth = depth_extrinsics(bag(), choose_topics(bag(), {}));
  EXPECT_EQ(depth.camera.fx, 40);
  EXPECT_TRUE(depth.color_from_depth.isApprox(kColorFromGroup * kDepthFromGroup.inverse()));
}

// The second number is that of the group: poses of two groups say nothing of each other.
TEST_F(RealSenseRecording, IsRefusedWhereItDoesNotSayIt) {
  transform("/device_0/sensor_0/Depth_0/tf/0", kDepthFromGroup);
  transform("/device_0/sensor_1/Color_0/tf/1", kColorFromGroup);
  add("/device_0/sensor_1/Color_0/tf/0", "geometry_msgs/Transform", {1, 2, 3});  // damaged
  const TopicChoice choice = choose_topics(bag(), {});
  EXPECT_THAT(
      error_text(Fault::kUsage, [&] { depth_extrinsics(bag(), choice); }),
      AllOf(HasSubstr("this is a recording of the RealSense SDK, whose depth is not registered"),
            HasSubstr("'0' does not say where a camera is"), HasSubstr("align_depth"),
            HasSubstr("set source.registered=true")));
}

TEST_F(RealSenseRecording, HasTheUnitOfItsDepth) {
  unit(0.0001F);
  unit(0.001F);  // changed later
  const TopicChoice choice = choose_topics(bag(), {});
  EXPECT_EQ(depth_factor_in_bag(bag(), choice.depth), 10000);
  EXPECT_EQ(depth_factor_in_bag(bag(), choice.color), 1000);  // of another sensor
}

TEST_F(RealSenseRecording, HasMillimetresWhereItSaysNothing) {
  unit(0);
  EXPECT_EQ(depth_factor_in_bag(bag(), choose_topics(bag(), {}).depth), 1000);
}

TEST(DepthFactor, OfACameraFileIsCompared) {
  CameraModel camera{.depth_factor = 5000};
  EXPECT_EQ(depth_factor_warning(camera),
            "16-bit depth of ROS is in millimetres, but the camera file has depth_factor 5000: set "
            "it to 1000, or source.depth_factor if these images differ");
  EXPECT_THAT(depth_factor_warning(camera, 4000),
              HasSubstr("16-bit depth of this recording has 4000 for a metre, but the camera file "
                        "has depth_factor 5000: set it to 4000"));
  camera.depth_factor = 1000;
  EXPECT_EQ(depth_factor_warning(camera), "");
}

}  // namespace
}  // namespace stillpoint::bag
