#include "ros2/ros2_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stop_token>
#include <thread>

#include "support/bag_messages.hpp"
#include "support/dds_loopback.hpp"
#include "support/error_text.hpp"
#include "support/source_frames.hpp"

namespace stillpoint::ros2 {
namespace {

using ::testing::AllOf;
using testing::camera_info_message;
using testing::color_image;
using ::testing::Contains;
using testing::depth_image;
using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using testing::error_text;
using ::testing::HasSubstr;
using testing::image_message;
using ::testing::IsEmpty;
using testing::loopback_domain;
using ::testing::Pointwise;

constexpr std::int64_t kStart = 1'305'031'102'175'304'000;  // ns
constexpr std::int64_t kInterval = 33'333'000;              // ns
constexpr auto kRos2 = bag::Serialisation::kCdr;

/// Publishers, and a source that hears them.
class Ros2SourceTest : public ::testing::Test {
 protected:
  Ros2SourceTest() {
    options_.domain = loopback_domain();
    options_.timeout = 0.1;
    options_.queue_size = 20;
    context_.log = [this](LogLevel, std::string_view line) { log_.emplace_back(line); };
  }
  Ros2Source& source() {
    if (!source_) source_.emplace(options_, context_);
    return *source_;
  }
  void info(const testing::TestCameraInfo& camera = {}) {
    source();
    info_.write(camera_info_message(kRos2, camera));
  }
  void color(int i, const std::string& encoding = "bgr8") {
    source();
    color_.write(image_message(kRos2, stamp(i), "camera", color_image(i), encoding));
  }
  void depth(int i, std::int64_t later = 0) {
    depth_.write(image_message(kRos2, stamp(i) + later, "camera", depth_image(1000 + i), "16UC1"));
  }
  static std::int64_t stamp(int i) { return kStart + kInterval * i; }

  const Participant participant_{loopback_domain()};
  const Writer color_{participant_, "rgb/image_raw", bag::kImageType, Kept::kShortly};
  const Writer depth_{participant_, "depth_registered/image_raw", bag::kImageType, Kept::kShortly};
  const Writer info_{participant_, "rgb/camera_info", bag::kCameraInfoType, Kept::kShortly};
  Ros2Source::Options options_;
  StageContext context_;
  std::vector<std::string> log_;
  std::optional<Ros2Source> source_;
};

TEST_F(Ros2SourceTest, GivesFramesUntilThereIsSilence) {
  info();
  for (int i = 0; i < 3; ++i) {
    color(i);
    depth(i);
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto frame = source().next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_DOUBLE_EQ(frame->time, bag::seconds(stamp(static_cast<int>(i))));
    EXPECT_EQ(frame->bgr.at<cv::Vec3b>(5, 7), cv::Vec3b(static_cast<std::uint8_t>(i), 100, 200));
    EXPECT_FLOAT_EQ(frame->depth.at<float>(5, 7), 1.0F + 0.001F * static_cast<float>(i));
    EXPECT_EQ(frame->camera->fx, 50);
  }
  EXPECT_FALSE(source().next());
  EXPECT_FALSE(source().next());
  EXPECT_THAT(log_.back(), HasSubstr("no images for 0.1 s: this is taken for the end"));
  EXPECT_THAT(source().report().warnings, IsEmpty());
}

TEST_F(Ros2SourceTest, EndsAfterTheLimit) {
  options_.limit = 1;
  info();
  color(0);
  depth(0);
  EXPECT_TRUE(source().next());
  EXPECT_FALSE(source().next());
}

TEST_F(Ros2SourceTest, TakesTheCameraOfThePipeline) {
  context_.camera = CameraModel{.name = "mine",
                                .width = testing::kImageWidth,
                                .height = testing::kImageHeight,
                                .fx = 60,
                                .depth_factor = 2000};
  color(0);
  depth(0);
  const auto frame = source().next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->camera->fx, 60);
  EXPECT_FLOAT_EQ(frame->depth.at<float>(5, 7), 0.5F);
  EXPECT_THAT(log_, Contains(HasSubstr("16-bit depth of ROS is in millimetres, but the camera file "
                                       "has depth_factor 2000: set it to 1000"))
                        .Times(1));
}

TEST_F(Ros2SourceTest, DoesNotTellOfADepthFactorThatIsSet) {
  context_.camera = CameraModel{
      .name = "mine", .width = testing::kImageWidth, .height = testing::kImageHeight, .fx = 60};
  options_.depth_factor = 1000;
  color(0);
  depth(0);
  EXPECT_TRUE(source().next());
  EXPECT_THAT(log_, Each(HasSubstr("waiting for")));
}

TEST_F(Ros2SourceTest, TakesTheProjectionOfRectifiedImages) {
  options_.rectified = true;
  info({.distortion = {0.1, 0.2, 0.3, 0.4, 0.5}});
  color(0);
  depth(0);
  EXPECT_EQ(source().next()->camera->fx, 45);
}

TEST_F(Ros2SourceTest, DropsImagesWithoutPartner) {
  info();
  color(0);
  color(1);
  depth(1);
  depth(2);
  color(3);
  depth(3);
  EXPECT_DOUBLE_EQ(source().next()->time, bag::seconds(stamp(1)));
  EXPECT_DOUBLE_EQ(source().next()->time, bag::seconds(stamp(3)));
  EXPECT_EQ(source().report().skipped, 2U);
  EXPECT_THAT(source().report().warnings, ElementsAre(HasSubstr("2 images had no partner")));
}

// After the first twelve, the queue keeps the newest twelve: 16 and 19 to 29.
TEST_F(Ros2SourceTest, CountsFramesThatCameTooFast) {
  options_.queue_size = 12;
  info();
  for (int i = 0; i < 30; ++i) {
    if (i == 17 || i == 18) continue;  // lost on the way
    color(i);
    depth(i);
    if (i == 11) {
      for (int k = 0; k < 12; ++k) ASSERT_TRUE(source().next());
    }
  }
  std::size_t given = 12;
  while (source().next()) ++given;
  EXPECT_EQ(given, 24U);
  EXPECT_EQ(source().report().skipped, 6U);
  EXPECT_THAT(source().report().warnings, ElementsAre(HasSubstr("about 6 frames are missing")));
}

TEST_F(Ros2SourceTest, CountsAnImageOnce) {
  info();
  for (int i = 0; i < 16; ++i) {
    if (i != 5) color(i);
    if (i != 9) depth(i);
  }
  while (source().next()) {
  }
  EXPECT_EQ(source().report().skipped, 2U);
  EXPECT_THAT(source().report().warnings, ElementsAre(HasSubstr("2 images had no partner")));
}

// Meanwhile it is counted after each 30 frames.
TEST_F(Ros2SourceTest, TellsWhileItGoesOnWhatIsMissing) {
  options_.queue_size = 40;
  info();
  for (int i = 0; i < 31; ++i) {
    if (i == 5) continue;
    color(i);
    depth(i);
  }
  for (int i = 0; i < 29; ++i) ASSERT_TRUE(source().next());
  EXPECT_EQ(source().left_out(), 0U);
  ASSERT_TRUE(source().next());
  EXPECT_EQ(source().left_out(), 1U);
}

TEST_F(Ros2SourceTest, PairsStampsThatDiffer) {
  options_.approximate = true;
  info();
  color(0);
  depth(0, 4'000'000);
  depth(1, 25'000'000);  // too late for the second colour image, too early for the third
  color(1);
  color(2);
  depth(2);
  EXPECT_DOUBLE_EQ(source().next()->time, bag::seconds(stamp(0)));
  EXPECT_DOUBLE_EQ(source().next()->time, bag::seconds(stamp(1) + kInterval));
}

// At 60 Hz, the depth image of a lost colour image is within 20 ms of the next one.
TEST_F(Ros2SourceTest, ALostImageDoesNotShiftThePairs) {
  options_.approximate = true;
  info();
  for (int i = 0; i < 9; ++i) {
    const std::int64_t time = kStart + kInterval / 2 * i;
    if (i != 4) color_.write(image_message(kRos2, time, "camera", color_image(i), "bgr8"));
    depth_.write(image_message(kRos2, time, "camera", depth_image(1000 + i), "16UC1"));
  }
  const auto frames = testing::frames_of(source());
  EXPECT_EQ(frames.size(), 8U);
  for (const Frame& frame : frames)
    EXPECT_FLOAT_EQ(frame.depth.at<float>(5, 7),
                    1.0F + 0.001F * static_cast<float>(frame.bgr.at<cv::Vec3b>(5, 7)[0]));
}

TEST_F(Ros2SourceTest, TimeGoesForward) {
  info();
  for (const int i : {5, 4, 6}) {
    color(i);
    depth(i);
  }
  EXPECT_DOUBLE_EQ(source().next()->time, bag::seconds(stamp(5)));
  EXPECT_DOUBLE_EQ(source().next()->time, bag::seconds(stamp(6)));
  EXPECT_THAT(source().report().warnings, ElementsAre(HasSubstr("1 pairs of images were not")));
}

/// Those that the stamps of these images would have.
std::vector<double> times_of_stamps(std::initializer_list<int> images) {
  std::vector<double> times;
  for (const int i : images) times.push_back(bag::seconds(kStart + kInterval * i));
  return times;
}

std::vector<double> times_of(Source& source) {
  std::vector<double> times;
  for (const Frame& frame : testing::frames_of(source)) times.push_back(frame.time);
  return times;
}

// By 2.1 s, then by 1.3 s.
TEST_F(Ros2SourceTest, TimeGoesOnWhenStampsGoBack) {
  info();
  for (const int i : {100, 101, 102, 40, 41, 39, 3, 4}) {
    color(i);
    depth(i);
  }
  EXPECT_THAT(times_of(source()),
              Pointwise(DoubleNear(1e-6), times_of_stamps({100, 101, 102, 103, 104, 105, 106})));
  EXPECT_THAT(log_, Contains(HasSubstr("the stamps went back by 2.1 s")).Times(1));
  EXPECT_THAT(log_, Contains(HasSubstr("the stamps went back by 1.3 s")).Times(1));
  EXPECT_EQ(source().report().skipped, 1U);  // the image 39, which is late
  EXPECT_THAT(source().report().warnings,
              ElementsAre(AllOf(HasSubstr("2 times"), HasSubstr("up to 3.4 s later")),
                          HasSubstr("1 pairs of images were not")));
}

TEST_F(Ros2SourceTest, AnImageOfTheOldClockBlocksNobody) {
  info();
  for (const int i : {100, 40, 41, 42}) color(i);
  for (const int i : {100, 101, 40, 41, 42}) depth(i);
  EXPECT_THAT(times_of(source()), Pointwise(DoubleNear(1e-3), times_of_stamps({100, 101, 102})));
}

// It would wait for an hour: for a camera, or for images of one that is known.
TEST_F(Ros2SourceTest, AStopEndsTheWait) {
  options_.timeout = 3600;
  for (const bool camera_is_known : {false, true}) {
    source_.reset();
    if (camera_is_known)
      context_.camera = CameraModel{
          .name = "mine", .width = testing::kImageWidth, .height = testing::kImageHeight, .fx = 60};
    std::stop_source stop;
    source().begin(stop.get_token());
    std::jthread user([&] { stop.request_stop(); });
    EXPECT_FALSE(source().next());
  }
  EXPECT_THAT(log_, Each(HasSubstr("waiting for")));
}

TEST_F(Ros2SourceTest, SaysWhichTopicIsSilent) {
  EXPECT_THAT(error_text(Fault::kData, [&] { source().next(); }),
              AllOf(HasSubstr("rgb/camera_info: no message for 0.1 s; publishers: 1"),
                    HasSubstr("see whether they publish")));
  info();
  color(0);
  EXPECT_THAT(error_text(Fault::kData, [&] { source().next(); }),
              HasSubstr("depth_registered/image_raw: no message for 0.1 s; publishers: 1"));
}

TEST_F(Ros2SourceTest, SaysThatNobodyPublishes) {
  options_.info_topic = "/none";
  EXPECT_THAT(
      error_text(Fault::kData, [&] { source().next(); }),
      AllOf(HasSubstr("/none: no message for 0.1 s; publishers: 0"), HasSubstr("source.timeout")));
}

TEST_F(Ros2SourceTest, RefusesDepthThatIsNotRegistered) {
  const Writer unregistered(participant_, "depth/image_raw", bag::kImageType, Kept::kShortly);
  options_.depth_topic = "depth/image_raw";
  const auto send_pair = [&] {
    source_.reset();
    info();
    color(0);
    unregistered.write(image_message(kRos2, stamp(0), "depth_frame", depth_image(1000), "16UC1"));
  };
  send_pair();
  EXPECT_THAT(error_text(Fault::kData, [&] { source().next(); }),
              AllOf(HasSubstr("depth/image_raw: the depth images are in the frame 'depth_frame', "
                              "those of rgb/image_raw in 'camera'"),
                    HasSubstr("set source.registered=true")));
  options_.registered = true;
  send_pair();
  EXPECT_TRUE(source().next());
}

TEST_F(Ros2SourceTest, RefusesAnEncoding) {
  info();
  color(0, "bgr99");
  depth(0);
  EXPECT_THAT(error_text(Fault::kData, [&] { source().next(); }),
              AllOf(HasSubstr("rgb/image_raw: "), HasSubstr("'bgr99'")));
}

TEST_F(Ros2SourceTest, RefusesAMessageThatIsCutShort) {
  source();
  info_.write({0, 1, 0, 0, 9, 9, 9, 9});
  EXPECT_THAT(error_text(Fault::kData, [&] { source().next(); }),
              HasSubstr("rgb/camera_info: the bytes end too early"));
}

TEST_F(Ros2SourceTest, RefusesImagesOfAnotherSizeThanTheirCamera) {
  info({.width = 640, .height = 480});
  color(0);
  depth(0);
  EXPECT_THAT(error_text(Fault::kData, [&] { source().next(); }), HasSubstr("rgb/image_raw: "));
}

}  // namespace
}  // namespace stillpoint::ros2
