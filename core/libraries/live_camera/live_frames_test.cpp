#include "live_camera/live_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace stillpoint::live_camera {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const CameraModel kTiny{.name = "tiny", .width = 16, .height = 16, .depth_factor = 1000};

constexpr double kTicksPerSecond = 1e3;  // a counter of milliseconds

cv::Mat color_image() { return {16, 16, CV_8UC3, cv::Scalar(1, 2, 3)}; }
cv::Mat depth_image(int millimetres) { return {16, 16, CV_16UC1, cv::Scalar(millimetres)}; }

void put(LiveFrames& frames, std::uint64_t milliseconds, int depth = 1500) {
  frames.put_color(milliseconds, color_image());
  frames.put_depth(milliseconds + 5, depth_image(depth));
}

/// Does what the test has written down for each start, and nothing after that.
class ScriptedDriver final : public LiveDriver {
 public:
  explicit ScriptedDriver(std::vector<std::function<void()>> starts = {})
      : starts_(std::move(starts)) {}
  void start() override {
    if (const auto now = started++; now < starts_.size()) starts_[now]();
  }
  void close() override { ++closed; }

  std::size_t started = 0;
  std::size_t closed = 0;

 private:
  std::vector<std::function<void()>> starts_;
};

std::string message_of(LiveFrames& frames, LiveDriver& driver) {
  try {
    frames.next(driver);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kData);
    return error.what();
  }
  return "nothing was thrown";
}

TEST(LiveFrames, GivesRectifiedFramesInOrder) {
  LiveFrames frames({}, kTiny, "camera", kTicksPerSecond, 64);
  put(frames, 500);
  put(frames, 600, 2500);
  ScriptedDriver driver;
  const auto first = frames.next(driver);
  const auto second = frames.next(driver);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->index, 0u);
  EXPECT_EQ(second->index, 1u);
  EXPECT_NEAR(second->time - first->time, 0.1, 2e-4);
  EXPECT_FLOAT_EQ(second->depth.at<float>(3, 3), 2.5f);
  EXPECT_EQ(second->bgr.at<cv::Vec3b>(3, 3), cv::Vec3b(1, 2, 3));
  EXPECT_THAT(frames.report().warnings, IsEmpty());
  EXPECT_EQ(driver.started, 1u);
}

TEST(LiveFrames, EndsAfterTheLimit) {
  LiveFrames frames({.limit = 1}, kTiny, "camera", kTicksPerSecond, 64);
  ScriptedDriver driver;
  put(frames, 500);
  EXPECT_TRUE(frames.next(driver));
  EXPECT_FALSE(frames.next(driver));
  EXPECT_FALSE(frames.next(driver));
}

TEST(LiveFrames, SaysWhenTheCameraStalls) {
  LiveFrames frames({.timeout = 0.1, .reconnect_for = 0}, kTiny, "Kinect 7", kTicksPerSecond, 64);
  ScriptedDriver driver;
  put(frames, 500);
  frames.next(driver);
  EXPECT_THAT(message_of(frames, driver),
              HasSubstr("Kinect 7: no pair of images for 0.1 s, after 1 frames"));
  EXPECT_EQ(driver.started, 1u);
}

// One that has never sent anything is not looked for again: it was set up wrongly.
TEST(LiveFrames, SaysWhyTheDriverEnded) {
  LiveFrames frames({}, kTiny, "camera", kTicksPerSecond, 64);
  ScriptedDriver driver({[&] { frames.end("the camera was unplugged"); }});
  EXPECT_THAT(message_of(frames, driver), HasSubstr("camera: the camera was unplugged"));
  EXPECT_EQ(driver.started, 1u);
}

/// A camera that sends a pair, and is unplugged.
class UnpluggedCamera : public ::testing::Test {
 protected:
  void send(std::uint64_t milliseconds) {
    put(frames, milliseconds);
    frames.end("the camera was unplugged");
  }
  [[noreturn]] static void be_away() { throw Error(Fault::kData, "no camera is connected"); }

  std::vector<std::string> logged;
  LiveFrames frames{{.reconnect_for = 60},
                    kTiny,
                    "Kinect",
                    kTicksPerSecond,
                    64,
                    [this](LogLevel, std::string_view text) { logged.emplace_back(text); }};
};

// Its counter begins at zero again.
TEST_F(UnpluggedCamera, GoesOnWhenItIsBack) {
  ScriptedDriver driver({[&] { send(90'000); }, be_away, [&] { send(30); }});
  const auto before = frames.next(driver);
  const auto after = frames.next(driver);
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->index, 1u);
  EXPECT_GT(after->time, before->time);
  EXPECT_EQ(driver.started, 3u);
  EXPECT_EQ(driver.closed, 2u);
  EXPECT_THAT(logged, ElementsAre(HasSubstr("Kinect: the camera was unplugged; trying to open it "
                                            "again for 60 s"),
                                  HasSubstr("Kinect: the camera is back, after ")));
  const SourceReport report = frames.report();
  EXPECT_EQ(report.skipped, 0u);
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("the camera was gone 1 time, for ")));
}

TEST_F(UnpluggedCamera, MayBeGoneSeveralTimes) {
  ScriptedDriver driver({[&] { send(500); }, [&] { send(30); }, [&] { send(20); }});
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto frame = frames.next(driver);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
  }
  EXPECT_THAT(frames.report().warnings, ElementsAre(HasSubstr("the camera was gone 2 times")));
}

TEST_F(UnpluggedCamera, IsNotWaitedForAfterAStop) {
  std::stop_source stop;
  frames.begin(stop.get_token());
  ScriptedDriver driver({[&] { send(500); },
                         [&] {
                           stop.request_stop();
                           be_away();
                         }});
  EXPECT_TRUE(frames.next(driver));
  EXPECT_FALSE(frames.next(driver));
  EXPECT_EQ(driver.started, 2u);
}

TEST(LiveFrames, SaysThatTheCameraWasNotBack) {
  LiveFrames frames({.reconnect_for = 0.1}, kTiny, "Kinect", kTicksPerSecond, 64);
  ScriptedDriver driver({[&] {
                           put(frames, 500);
                           frames.end("the camera was unplugged");
                         },
                         [] { throw Error(Fault::kData, "no camera is connected"); }});
  EXPECT_TRUE(frames.next(driver));
  EXPECT_THAT(message_of(frames, driver),
              HasSubstr("Kinect: the camera was unplugged, and it was not back after 0.1 s"));
}

// The camera stalls for an hour.
TEST(LiveFrames, AStopEndsTheWait) {
  LiveFrames frames({.timeout = 3600}, kTiny, "camera", kTicksPerSecond, 64);
  std::stop_source stop;
  frames.begin(stop.get_token());
  ScriptedDriver driver({[&] { put(frames, 500); }});
  EXPECT_TRUE(frames.next(driver));
  std::jthread user([&] { stop.request_stop(); });
  EXPECT_FALSE(frames.next(driver));
}

TEST(LiveFrames, TimesOnlyGrow) {
  LiveFrames frames({.timeout = 0.1}, kTiny, "camera", kTicksPerSecond, 64);
  ScriptedDriver driver;
  put(frames, 500);
  const double first = frames.next(driver)->time;
  put(frames, 400);
  put(frames, 600);
  EXPECT_NEAR(frames.next(driver)->time - first, 0.1, 2e-4);
  EXPECT_EQ(frames.left_out(), 1u);
  EXPECT_EQ(frames.report().skipped, 1u);
}

TEST(LiveFrames, ReportsWhatWasLeftOut) {
  std::vector<std::string> logged;
  LiveFrames frames({}, kTiny, "camera", kTicksPerSecond, 64,
                    [&](LogLevel, std::string_view text) { logged.emplace_back(text); });
  for (int i = 0; i < 5; ++i) put(frames, 100 * i);
  frames.put_color(600, color_image());
  frames.put_color(700, color_image());
  frames.put_depth(700, depth_image(1000));
  frames.put_depth(900'000, depth_image(1000));  // a quarter of an hour ahead
  const SourceReport report = frames.report();
  EXPECT_EQ(report.skipped, 5u);
  EXPECT_THAT(report.warnings,
              ElementsAre(HasSubstr("4 pairs of images came while two were waiting"),
                          HasSubstr("1 images had no partner within 20 ms"),
                          HasSubstr("the device's clock jumped 1 times")));
  EXPECT_EQ(logged, report.warnings);
}

TEST(LiveModel, IsTheCalibrationWithDepthInMillimetres) {
  StageContext context;
  context.camera = CameraModel{.name = "mine", .width = 640, .height = 480, .fx = 517};
  const CameraModel model = live_model(context, "camera", 640, 480, 1.0);
  EXPECT_EQ(model.fx, 517);
  EXPECT_EQ(model.depth_factor, 1000);
  EXPECT_THROW(live_model(context, "camera", 320, 240, 1.0), Error);
}

TEST(LiveModel, IsAnIdealCameraWithoutCalibrationAndSaysSo) {
  StageContext context;
  std::vector<std::string> warnings;
  context.log = [&](LogLevel level, std::string_view text) {
    if (level == LogLevel::kWarning) warnings.emplace_back(text);
  };
  const CameraModel model = live_model(context, "camera", 640, 480, std::numbers::pi / 2);
  EXPECT_NEAR(model.fx, 320, 1e-9);
  EXPECT_EQ(model.cx, 319.5);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("no calibration is given")));
  EXPECT_THROW(live_model(context, "camera", 640, 480, 0.0), Error);
}

}  // namespace
}  // namespace stillpoint::live_camera
