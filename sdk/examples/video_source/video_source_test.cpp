#include "video_source.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stillpoint/testing/test_recording.hpp>

namespace {

namespace fs = std::filesystem;
using stillpoint::testing::TestRecording;

constexpr std::size_t kFrames = 3;

const TestRecording& recording() {
  static const TestRecording recording({.frames = kFrames});
  return recording;
}

fs::path depth_file(const fs::path& folder, std::size_t i) {
  return folder / "depth" / (std::to_string(i) + ".png");
}

/// A video of three frames with all that belongs to it.
void write_recording(const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder / "depth");
  cv::VideoWriter video((folder / "video.avi").string(), cv::CAP_OPENCV_MJPEG,
                        cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 30, {320, 240});
  std::ofstream times(folder / "times.txt");
  for (std::size_t i = 0; i < kFrames; ++i) {
    video.write(recording().frame(i)->bgr);
    cv::Mat depth;
    recording().frame(i)->depth.convertTo(depth, CV_16U, 5000);
    cv::imwrite(depth_file(folder, i).string(), depth);
    times << 10 + recording().frame(i)->time << '\n';
  }
  std::ofstream(folder / "camera.yaml") << "camera: {width: 320, height: 240, fx: 262.4, fy: "
                                           "262.4, cx: 159.5, cy: 119.5, depth_factor: 5000}\n";
}

/// A recording for each test, to be damaged.
class VideoSourceTest : public ::testing::Test {
 protected:
  VideoSourceTest() { write_recording(folder_); }
  ~VideoSourceTest() override { fs::remove_all(folder_); }

  VideoSource open() const {
    stillpoint::StageContext context = stillpoint::testing::test_context();
    context.camera = {.name = "mine", .width = 320, .height = 240};
    return {{.path = folder_.string()}, context};
  }
  /// Reads all, and gives the message of the error that ends it.
  std::string message() const {
    try {
      VideoSource source = open();
      while (source.next()) continue;
    } catch (const stillpoint::Error& error) {
      EXPECT_EQ(error.fault(), stillpoint::Fault::kData);
      return error.what();
    }
    return "no error";
  }
  void expect_message_with(const std::string& words) const {
    EXPECT_NE(message().find(words), std::string::npos) << message();
  }

  const fs::path folder_ = fs::path(::testing::TempDir()) / "video_source_test";
};

TEST(PluginsCheck, GetsARecording) { write_recording("video"); }

TEST_F(VideoSourceTest, GivesColourDepthAndTimes) {
  VideoSource source = open();
  EXPECT_EQ(source.size(), kFrames);
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_NEAR(frame->time, 10 + recording().frame(i)->time, 1e-3);
    const double pixels = static_cast<double>(frame->gray.total());
    EXPECT_LT(cv::norm(frame->gray, recording().frame(i)->gray, cv::NORM_L1) / pixels, 5);
    EXPECT_LT(cv::norm(frame->depth, recording().frame(i)->depth, cv::NORM_INF), 2e-4);
  }
  EXPECT_FALSE(source.next());
}

TEST_F(VideoSourceTest, SaysWhatIsMissing) {
  fs::remove(folder_ / "video.avi");
  expect_message_with("video.avi: there is no such file");
  fs::remove(folder_ / "times.txt");
  expect_message_with("times.txt: there is no such file");
}

TEST_F(VideoSourceTest, SaysWhatIsNoVideo) {
  std::ofstream(folder_ / "video.avi") << "Not Found";
  expect_message_with("video.avi: OpenCV cannot read this as a video");
}

TEST_F(VideoSourceTest, SaysThatDepthImagesAreMissing) {
  fs::remove(depth_file(folder_, 2));
  expect_message_with("2 depth images, but 3 times");
  std::ofstream(folder_ / "times.txt") << "1\n2\n";
  expect_message_with("the video goes on, but there are only 2 depth images");
}

TEST_F(VideoSourceTest, SaysThatSizesDiffer) {
  cv::imwrite(depth_file(folder_, 1).string(), cv::Mat(24, 32, CV_16UC1, cv::Scalar(5000)));
  expect_message_with("images have 32 x 24 pixels, but camera 'mine' has 320 x 240");
  cv::imwrite(depth_file(folder_, 0).string(), cv::Mat(240, 320, CV_8UC1, cv::Scalar(9)));
  expect_message_with("0.png: this is no PNG with one channel of 16 bits");
}

TEST_F(VideoSourceTest, SaysWhatIsNoTime) {
  std::ofstream(folder_ / "times.txt") << "# seconds\n1.0\n1.0\n2.0\n";
  expect_message_with("times.txt:3: this time is not later than the one before");
  std::ofstream(folder_ / "times.txt") << "soon\n";
  expect_message_with("times.txt:1: 'soon' is no time in seconds");
}

TEST_F(VideoSourceTest, AShortVideoIsReported) {
  cv::imwrite(depth_file(folder_, 3).string(), cv::Mat(240, 320, CV_16UC1, cv::Scalar(5000)));
  std::ofstream(folder_ / "times.txt", std::ios::app) << "99\n";
  VideoSource source = open();
  while (source.next()) continue;
  EXPECT_EQ(source.report().skipped, 1u);
}

}  // namespace
