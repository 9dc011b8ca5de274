#include "source_video/video_file_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "support/error_text.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"
#include "support/source_frames.hpp"

namespace stillpoint::source_video {
namespace {

namespace fs = std::filesystem;
using testing::color_image;
using testing::depth_image;
using ::testing::ElementsAre;
using testing::error_text;
using testing::frames_of;
using ::testing::HasSubstr;
using testing::kImageHeight;
using testing::kImageWidth;

constexpr int kFrames = 4;
constexpr double kRate = 25;  // Hz, of the video

/// A video of four images of one colour each, and four depth images, for each test to be damaged.
class VideoFileSourceTest : public ::testing::Test {
 protected:
  VideoFileSourceTest() {
    fs::create_directories(depths());
    cv::VideoWriter video((folder() / "video.avi").string(), cv::CAP_OPENCV_MJPEG,
                          cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kRate,
                          {kImageWidth, kImageHeight});
    for (int i = 0; i < kFrames; ++i) {
      video.write(color_image(50 * i));
      write_depth(std::to_string(i), depth_image(1000 + i));
    }
    options_.path = folder().string();
    context_.camera = CameraModel{.name = "mine",
                                  .width = kImageWidth,
                                  .height = kImageHeight,
                                  .fx = 60,
                                  .fy = 60,
                                  .depth_factor = 1000};
  }
  const fs::path& folder() const { return folder_.path(); }
  fs::path depths() const { return folder() / "depth"; }
  void write_depth(const std::string& name, const cv::Mat& image) const {
    testing::write_image(depths() / (name + ".png"), image);
  }
  void rename_depth(int i, const std::string& name) const {
    fs::rename(depths() / (std::to_string(i) + ".png"), depths() / (name + ".png"));
  }
  VideoFileSource source() const { return {options_, context_}; }
  /// Of reading all.
  std::string failure(Fault fault = Fault::kData) const {
    return error_text(fault, [this] {
      VideoFileSource video(options_, context_);
      frames_of(video);
    });
  }

  const testing::TemporaryFolder folder_;
  VideoFileSource::Options options_;
  StageContext context_;
};

TEST_F(VideoFileSourceTest, GivesColourAndDepthAtTheRateOfTheVideo) {
  options_.first_time = 100;
  VideoFileSource video = source();
  EXPECT_EQ(video.size(), std::size_t{kFrames});
  const auto frames = frames_of(video);
  ASSERT_EQ(frames.size(), std::size_t{kFrames});
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_EQ(frames[i].index, static_cast<std::uint32_t>(i));
    EXPECT_NEAR(frames[i].time, 100 + i / kRate, 1e-9);
    EXPECT_NEAR(frames[i].bgr.at<cv::Vec3b>(5, 7)[0], 50 * i, 6);
    EXPECT_FLOAT_EQ(frames[i].depth.at<float>(5, 7), 1.0f + 0.001f * static_cast<float>(i));
  }
  EXPECT_EQ(video.report().skipped, 0u);
}

TEST_F(VideoFileSourceTest, TakesTimesOfAList) {
  options_.times = "times.txt";
  folder_.write("times.txt", "# seconds\n7.0 first\n7.1\n7.5\n7.6\n");
  VideoFileSource video = source();
  const auto frames = frames_of(video);
  ASSERT_EQ(frames.size(), std::size_t{kFrames});
  EXPECT_EQ(frames[2].time, 7.5);
}

TEST_F(VideoFileSourceTest, PairsByTheNamesOfDepthImages) {
  options_.pair_by = PairBy::kTime;  // images at 0, 0.04, 0.08 and 0.12 s
  rename_depth(0, "0.001");
  fs::remove(depths() / "1.png");
  rename_depth(2, "0.0795");
  rename_depth(3, "10.5");
  VideoFileSource video = source();
  const auto frames = frames_of(video);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_NEAR(frames[1].time, 0.08, 1e-9);
  EXPECT_FLOAT_EQ(frames[1].depth.at<float>(5, 7), 1.002f);
  EXPECT_EQ(video.report().skipped, 2u);
  EXPECT_THAT(video.report().warnings, ElementsAre(HasSubstr("2 images of the video have no")));
}

// Each depth image is within 20 ms of the image before its own.
TEST_F(VideoFileSourceTest, PairsAFastVideoWithEveryOtherDepthImage) {
  options_.pair_by = PairBy::kTime;
  options_.rate = 60;
  rename_depth(0, "0.0");
  rename_depth(1, "0.033333");
  for (const int left_out : {2, 3}) fs::remove(depths() / (std::to_string(left_out) + ".png"));
  VideoFileSource video = source();
  const auto frames = frames_of(video);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_NEAR(frames[1].time, 2 / 60.0, 1e-9);
  EXPECT_FLOAT_EQ(frames[1].depth.at<float>(5, 7), 1.001f);
}

TEST_F(VideoFileSourceTest, EndsAfterTheLimit) {
  options_.limit = 2;
  VideoFileSource video = source();
  EXPECT_EQ(video.size(), 2u);
  EXPECT_EQ(frames_of(video).size(), 2u);
}

TEST_F(VideoFileSourceTest, SaysWhatIsMissing) {
  options_.times = "times.txt";
  EXPECT_THAT(failure(), HasSubstr("times.txt: "));
  options_.times.clear();
  fs::remove(folder() / "video.avi");
  EXPECT_THAT(failure(), HasSubstr("video.avi: there is no such file"));
  fs::remove_all(depths());
  EXPECT_THAT(failure(), HasSubstr("depth: there is no such folder"));
  fs::create_directories(depths());
  EXPECT_THAT(failure(), HasSubstr("depth: there is no .png in this folder"));
  options_.path.clear();
  EXPECT_THAT(failure(Fault::kUsage), HasSubstr("no recording is given"));
}

TEST_F(VideoFileSourceTest, NeedsACamera) {
  context_.camera.reset();
  EXPECT_THAT(failure(Fault::kUsage), HasSubstr("no camera is given; put a camera.yaml beside"));
}

TEST_F(VideoFileSourceTest, SaysWhatIsNoVideo) {
  folder_.write("video.avi", "Not Found");
  EXPECT_THAT(failure(), HasSubstr("video.avi: OpenCV cannot read this as a video"));
}

TEST_F(VideoFileSourceTest, SaysThatTheCameraIsOfAnotherSize) {
  context_.camera->width = 640;
  EXPECT_THAT(
      failure(),
      HasSubstr("video.avi: the images have 64 x 48 pixels, but camera 'mine' has 640 x 48"));
}

TEST_F(VideoFileSourceTest, SaysThatDepthIsOfAnotherKindOrSize) {
  write_depth("0", cv::Mat(kImageHeight, kImageWidth, CV_8UC1, cv::Scalar(9)));
  EXPECT_THAT(failure(), HasSubstr("0.png: a depth image must be 16-bit with 1 channel"));
  write_depth("0", cv::Mat(24, 32, CV_16UC1, cv::Scalar(1000)));
  EXPECT_THAT(failure(), HasSubstr("0.png: the image has 32 x 24 pixels, but the camera has 64 x"));
}

TEST_F(VideoFileSourceTest, LeavesOutADamagedDepthImage) {
  fs::resize_file(depths() / "1.png", 40);
  VideoFileSource video = source();
  EXPECT_EQ(frames_of(video).size(), 3u);
  EXPECT_EQ(video.report().skipped, 1u);
  EXPECT_THAT(video.report().warnings, ElementsAre(HasSubstr("1.png")));
}

TEST_F(VideoFileSourceTest, SaysThatDepthImagesAreMissing) {
  fs::remove(depths() / "3.png");
  EXPECT_THAT(failure(), HasSubstr("the video goes on, but there are only 3 depth images"));
  options_.times = "times.txt";
  folder_.write("times.txt", "1\n2\n");
  EXPECT_THAT(failure(), HasSubstr("3 depth images, but 2 times in times.txt"));
}

TEST_F(VideoFileSourceTest, TellsOfAVideoThatIsTooShort) {
  write_depth("4", depth_image(1000));
  VideoFileSource video = source();
  EXPECT_EQ(frames_of(video).size(), std::size_t{kFrames});
  EXPECT_THAT(video.report().warnings, ElementsAre(HasSubstr("ended after 4 of 5 images")));
}

TEST_F(VideoFileSourceTest, SaysWhatIsNoTime) {
  options_.pair_by = PairBy::kTime;
  rename_depth(1, "second");
  EXPECT_THAT(failure(), HasSubstr("second.png: the name is no time in seconds"));
  fs::remove(depths() / "second.png");
  options_.times = "times.txt";
  folder_.write("times.txt", "1.0\n1.0\n");
  EXPECT_THAT(failure(), HasSubstr("times.txt:2: this time is not later than the one before"));
  folder_.write("times.txt", "soon\n");
  EXPECT_THAT(failure(), HasSubstr("times.txt:1: 'soon' is not a time stamp"));
}

TEST_F(VideoFileSourceTest, SaysThatNoTimeFits) {
  options_.pair_by = PairBy::kTime;
  options_.first_time = 5000;
  EXPECT_THAT(failure(), HasSubstr("no image of the video has a depth image within"));
}

}  // namespace
}  // namespace stillpoint::source_video
