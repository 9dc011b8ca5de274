#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "source_bag/bag_source_fixture.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "support/error_text.hpp"
#include "support/source_frames.hpp"

namespace stillpoint::source_bag {
namespace {

using ::testing::AllOf;
using testing::BagBytes;
using testing::BagStyle;
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

BagBytes encoded(const cv::Mat& image, const std::string& ending = ".png") {
  return encode_image(ending, image);
}

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
