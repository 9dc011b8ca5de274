#include "inspection/bag_audit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "support/bag_writer.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::inspection {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BagAuditTest : public ::testing::Test {
 protected:
  void info() {
    writer_->add("/color/camera_info", "sensor_msgs/CameraInfo", stamp(0),
                 stillpoint::testing::camera_info_message(kind_));
  }
  void pair(int i, const std::string& depth_frame = "c") {
    image("/color/image", "c", stamp(i), CV_8UC3, "rgb8");
    image("/depth/image", depth_frame, stamp(i) + 4'000'000, CV_16UC1, "16UC1");
  }
  void image(const std::string& topic, const std::string& frame, std::int64_t time, int type,
             const std::string& encoding) {
    const double value = type == CV_8UC3 ? 140 : 2000;
    writer_->add(topic, "sensor_msgs/Image", time,
                 stillpoint::testing::image_message(
                     kind_, time, frame, cv::Mat(48, 64, type, cv::Scalar::all(value)), encoding));
  }
  BagAudit audit(const BagAuditOptions& options = {}) {
    writer_->finish();
    return audit_bag(file_, options);
  }
  static std::int64_t stamp(int i) { return 1'000'000'000 + 100'000'000LL * i; }

  stillpoint::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.mcap";
  std::unique_ptr<stillpoint::testing::BagWriter> writer_ =
      stillpoint::testing::make_bag_writer(file_, {"mcap", "zstd"});
  bag::Serialisation kind_ = writer_->serialisation();
};

TEST_F(BagAuditTest, CountsASoundBag) {
  info();
  for (int i = 0; i < 20; ++i) pair(i);
  writer_->add("/imu", "sensor_msgs/Imu", stamp(3), {0, 1, 0, 0});
  const BagAudit result = audit();
  ASSERT_EQ(result.topics.size(), 4U);
  EXPECT_EQ(result.topics[1].topic.name, "/color/image");
  EXPECT_EQ(result.topics[1].messages.images, 20U);
  EXPECT_EQ(result.topics[1].images, "64 x 48, rgb8");
  EXPECT_EQ(result.choice.value().depth.name, "/depth/image");
  EXPECT_EQ(result.pairs.images, 20U);
  EXPECT_NEAR(result.mean_difference, 0.004, 1e-9);
  EXPECT_EQ(result.camera.value().fx, 50);
  EXPECT_THAT(result.warnings, IsEmpty());
  EXPECT_THAT(report_table(result),
              AllOf(HasSubstr("format            MCAP"), HasSubstr("/imu"),
                    HasSubstr("/color/image: 20 images in 1.90 s, 10.0 Hz, no gaps"),
                    HasSubstr("fx 50.0, fy 51.0"), HasSubstr("No problems found.")));
  const auto json = report_json(result);
  EXPECT_EQ(json["color"]["topic"], "/color/image");
  EXPECT_EQ(json["pairs"]["images"], 20);
  EXPECT_EQ(json["topics"].size(), 4U);
  EXPECT_EQ(json["camera"]["width"], 64);
}

TEST_F(BagAuditTest, ReadsImages) {
  info();
  for (int i = 0; i < 18; ++i) pair(i);
  image("/color/image", "c", stamp(18), CV_8UC1, "rgb8");  // a third of the bytes that it needs
  image("/depth/image", "c", stamp(18), CV_16UC1, "16UC1");
  const cv::Mat half = (cv::Mat_<float>(1, 2) << 2.0F, std::numeric_limits<float>::quiet_NaN());
  image("/color/image", "c", stamp(19), CV_8UC3, "rgb8");
  writer_->add(
      "/depth/image", "sensor_msgs/Image", stamp(19),
      stillpoint::testing::image_message(kind_, stamp(19), "c", cv::repeat(half, 48, 32), "32FC1"));
  const BagAudit result = audit();
  EXPECT_EQ(result.sampled, 20U);
  EXPECT_THAT(result.color_kinds,
              ElementsAre(::testing::Pair("64 x 48, 8 bit, 3 channels, rgb8", 19)));
  EXPECT_THAT(result.depth_kinds,
              ElementsAre(::testing::Pair("64 x 48, 16 bit, 1 channel, 16UC1", 19),
                          ::testing::Pair("64 x 48, 32 bit, 1 channel, 16UC1", 1)));
  EXPECT_DOUBLE_EQ(result.depth_values.valid_share(), 39.0 / 40);
  EXPECT_EQ(result.depth_values.quantile(0.5), 2000);
  EXPECT_THAT(result.unreadable, ElementsAre(AllOf(HasSubstr("/color/image at 2.8"),
                                                   HasSubstr("fewer bytes than its size"))));
  EXPECT_THAT(result.warnings, Contains(HasSubstr("1 of 40 sampled images cannot be used")));
  EXPECT_THAT(report_table(result), AllOf(HasSubstr("damaged images    1 of those sampled"),
                                          HasSubstr("97.5 % of the pixels"),
                                          HasSubstr("half than 2.00 m, 95 % than 2.00 m")));
  EXPECT_EQ(report_json(result)["depth_values"]["factor"], 1000);
}

TEST_F(BagAuditTest, FindsTheDepthCameraBesideTheColourCamera) {
  info();
  writer_->add("/depth/camera_info", "sensor_msgs/CameraInfo", stamp(0),
               stillpoint::testing::camera_info_message(kind_, {.frame = "d"}));
  const Pose color_from_depth(Eigen::Translation3d(0.015, 0, 0));
  writer_->add("/tf_static", "tf2_msgs/TFMessage", stamp(0),
               stillpoint::testing::transforms_message(kind_, {{"c", "d", color_from_depth}}));
  for (int i = 0; i < 20; ++i) pair(i, "d");
  const BagAudit result = audit();
  EXPECT_THAT(result.warnings, IsEmpty());
  EXPECT_TRUE(result.color_from_depth.value().isApprox(color_from_depth));
  EXPECT_THAT(report_table(result), HasSubstr("15.0 mm beside, registered to colour"));
  EXPECT_EQ(report_json(result)["depth_camera"]["width"], 64);
}

TEST_F(BagAuditTest, SaysWhatIsWrong) {
  for (int i = 0; i < 20; ++i)
    if (i < 8 || i > 15) pair(i, "d");
  for (int i = 8; i < 10; ++i) image("/color/image", "c", stamp(i), CV_8UC3, "rgb8");
  EXPECT_THAT(audit().warnings,
              ElementsAre(AllOf(HasSubstr("has no CameraInfo of /color/image"),
                                HasSubstr("--info-topic NAME for inspect")),
                          HasSubstr("colour of /color/image in 'c', and cannot be registered"),
                          HasSubstr("2 of 14 colour images have no depth image"),
                          HasSubstr("no frames for 0.90 s from 1.700 s")));
}

TEST_F(BagAuditTest, TellsTheTopicsAlsoWithoutAChoice) {
  image("/color/image", "c", stamp(0), CV_8UC3, "rgb8");
  const BagAudit result = audit();
  EXPECT_FALSE(result.choice.has_value());
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("there is no topic with depth images")));
  EXPECT_THAT(report_table(result), HasSubstr("64 x 48, rgb8"));
  EXPECT_TRUE(report_json(result)["camera"].is_null());
}

TEST_F(BagAuditTest, TellsDamage) {
  info();
  for (int i = 0; i < 20; ++i) pair(i);
  writer_->finish();
  stillpoint::testing::truncate_file(file_, 0.6);
  EXPECT_THAT(audit_bag(file_, {}).warnings, Contains(HasSubstr("cut off")));
}

}  // namespace
}  // namespace stillpoint::inspection
