// Writes a bag and opens it with the source.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "source_bag/bag_source.hpp"
#include "support/bag_writer.hpp"
#include "support/recording_writer.hpp"
#include "support/source_frames.hpp"

namespace stillpoint::source_bag {

inline constexpr std::int64_t kStart = 1'305'031'102'175'304'000;  // ns
inline constexpr std::int64_t kInterval = 33'333'000;              // ns
inline constexpr const char* kColor = "/camera/color/image_raw";
inline constexpr const char* kDepth = "/camera/depth_registered/image_raw";
inline constexpr const char* kUnregistered = "/camera/depth/image_raw";

/// A bag of this style with images of 64 × 48 pixels.
class BagSourceTest : public ::testing::TestWithParam<testing::BagStyle> {
 protected:
  explicit BagSourceTest(const testing::BagStyle& style)
      : file_(folder_.path() / ("a." + style.format)),
        writer_(testing::make_bag_writer(file_, style)),
        serialisation_(writer_->serialisation()) {}
  BagSourceTest() : BagSourceTest(GetParam()) {}

  void add(const std::string& topic, const std::string& type, std::int64_t time,
           const testing::BagBytes& message) {
    writer_->add(topic, type, time + 5'000'000, message);  // it arrives later
  }
  void color(int i, const std::string& frame = "color_frame") {
    add(kColor, "sensor_msgs/Image", stamp(i),
        testing::image_message(serialisation_, stamp(i), frame, testing::color_image(i), "bgr8"));
  }
  void depth(int i, const std::string& frame = "color_frame", const char* topic = kDepth) {
    add(topic, "sensor_msgs/Image", stamp(i),
        testing::image_message(serialisation_, stamp(i) + 4'000'000, frame,
                               testing::depth_image(1000 + i), "16UC1"));
  }
  void info(const testing::TestCameraInfo& camera = {}) {
    add("/camera/color/camera_info", "sensor_msgs/CameraInfo", stamp(0),
        testing::camera_info_message(serialisation_, camera));
  }
  void depth_info() {
    add("/camera/depth/camera_info", "sensor_msgs/CameraInfo", stamp(0),
        testing::camera_info_message(serialisation_, {.frame = "depth_frame"}));
  }
  /// The depth camera is 10 cm to the left of the colour camera.
  void tf() {
    const Pose color_from_depth(Eigen::Translation3d(0.1, 0, 0));
    add("/tf_static", "tf2_msgs/TFMessage", stamp(0),
        testing::transforms_message(serialisation_,
                                    {{"color_frame", "depth_frame", color_from_depth}}));
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
  testing::TemporaryFolder folder_;
  std::filesystem::path file_;
  std::unique_ptr<testing::BagWriter> writer_;
  bag::Serialisation serialisation_;
};

/// For what no format concerns.
class OneBagSourceTest : public BagSourceTest {
 protected:
  OneBagSourceTest() : BagSourceTest(testing::BagStyle{"mcap", "none"}) {}
};

}  // namespace stillpoint::source_bag
