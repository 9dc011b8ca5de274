// With the device that OpenNI 2 makes up for tests: 320 x 240 pixels at 30 Hz, in colour and depth.
#include "source_openni2/openni2_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

namespace stillpoint::source_openni2 {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

OpenNi2Source::Options dummy() {
  OpenNi2Source::Options options;
  options.device = "Dummy";
  options.width = 320;
  options.height = 240;
  options.live.limit = 4;
  return options;
}

StageContext small_camera() {
  StageContext context;
  context.camera = CameraModel{
      .name = "small", .width = 320, .height = 240, .fx = 260, .fy = 260, .cx = 159.5, .cy = 119.5};
  return context;
}

std::string message_of(const OpenNi2Source::Options& options, const StageContext& context) {
  try {
    OpenNi2Source source(options, context);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

bool dummy_is_there() { return message_of(dummy(), small_camera()) == "nothing was thrown"; }

#define NEEDS_DUMMY() \
  if (!dummy_is_there()) GTEST_SKIP() << "OpenNI 2 has no driver DummyDevice here"

TEST(OpenNi2Source, GivesFramesOfADevice) {
  NEEDS_DUMMY();
  OpenNi2Source source(dummy(), small_camera());
  double last = 0.0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->bgr.size(), cv::Size(320, 240));
    EXPECT_EQ(frame->depth.type(), CV_32FC1);
    EXPECT_GT(frame->time, last);
    last = frame->time;
  }
  EXPECT_FALSE(source.next());
}

TEST(OpenNi2Source, ListsTheModesOfTheDevice) {
  NEEDS_DUMMY();
  auto options = dummy();
  options.width = 640;
  options.height = 480;
  EXPECT_THAT(
      message_of(options, small_camera()),
      AllOf(HasSubstr("it has no colour images of 640 x 480 at 30 Hz, but 320 x 240 at 30 Hz"),
            HasSubstr("set width, height and rate")));
}

TEST(OpenNi2Source, AsksForACameraWhereTheDeviceDoesNotTellItsFieldOfView) {
  NEEDS_DUMMY();
  EXPECT_THAT(message_of(dummy(), StageContext{}),
              AllOf(HasSubstr("no camera is given"), HasSubstr("--camera")));
}

TEST(OpenNi2Source, SaysThatNoSuchCameraIsThere) {
  auto options = dummy();
  options.device = "freenect://7";
  EXPECT_THAT(message_of(options, small_camera()),
              AllOf(HasSubstr("freenect://7"), HasSubstr("the camera cannot be opened")));
}

TEST(OpenNi2Source, RefusesRecordings) {
  auto options = dummy();
  for (const char* file : {"walk.oni", "/data/WALK.ONI", ".oni"}) {
    options.device = file;
    EXPECT_THAT(message_of(options, small_camera()),
                AllOf(HasSubstr(file), HasSubstr("a recording of OpenNI"), HasSubstr("TUM format"),
                      HasSubstr("stillpoint record")));
  }
}

}  // namespace
}  // namespace stillpoint::source_openni2
