#include "source_tum/tum_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "stillpoint/support/image_codec.hpp"
#include "support/error_text.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"
#include "support/shared_data.hpp"
#include "support/source_frames.hpp"

namespace stillpoint::source_tum {
namespace {

using tum_recording::open_recording;
using tum_recording::PairsFrom;

using ::testing::AllOf;
using testing::color_image;
using testing::depth_image;
using testing::error_text;
using testing::frames_of;
using ::testing::HasSubstr;
using testing::kImageHeight;
using testing::kImageWidth;
using testing::RecordingWriter;
using testing::TemporaryFolder;
using testing::truncate_file;

StageContext small_camera() {
  StageContext context;
  context.camera = CameraModel{.name = "tiny", .width = kImageWidth, .height = kImageHeight};
  return context;
}

TumSource::Options options_for(const std::filesystem::path& folder) {
  TumSource::Options options;
  options.path = folder.string();
  return options;
}

class TumSourceTest : public ::testing::Test {
 protected:
  /// A recording of `count` pairs at 1.0, 1.1 … s.
  void write(int count) {
    for (int i = 0; i < count; ++i) {
      color_files_.push_back(writer_.color(1.0 + 0.1 * i, color_image(i)));
      depth_files_.push_back(writer_.depth(1.0 + 0.1 * i, depth_image(5000 + i)));
    }
  }
  TumSource open(TumSource::Options options) {
    writer_.finish();
    return TumSource(options, small_camera());
  }
  TumSource open() { return open(options_for(folder_.path())); }

  /// Expects that the middle one of five pairs is left out, with this reason.
  void expect_skipped(const std::string& reason) {
    TumSource source = open();
    const auto frames = frames_of(source);
    ASSERT_EQ(frames.size(), 4u);
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(frames[i].index, i);
    EXPECT_NEAR(frames[2].time, 1.3, 1e-9);
    EXPECT_EQ(source.report().skipped, 1u);
    ASSERT_EQ(source.report().warnings.size(), 1u);
    EXPECT_THAT(source.report().warnings[0], HasSubstr(reason));
    EXPECT_THAT(source.report().warnings[0], HasSubstr("1.200000.png"));
  }

  TemporaryFolder folder_;
  RecordingWriter writer_{folder_.path()};
  std::vector<std::filesystem::path> color_files_;
  std::vector<std::filesystem::path> depth_files_;
};

TEST_F(TumSourceTest, GivesFramesInOrder) {
  write(3);
  TumSource source = open();
  EXPECT_EQ(source.size(), 3u);
  const auto frames = frames_of(source);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[2].index, 2u);
  EXPECT_NEAR(frames[2].time, 1.2, 1e-9);
  EXPECT_EQ(frames[2].bgr.at<cv::Vec3b>(5, 7), cv::Vec3b(2, 100, 200));
  EXPECT_EQ(frames[2].gray.type(), CV_8UC1);
  EXPECT_EQ(frames[2].depth.at<float>(5, 7), 5002.f / 5000.f);
  EXPECT_EQ(frames[2].camera->width, kImageWidth);
  EXPECT_EQ(source.report().skipped, 0u);
  EXPECT_FALSE(source.next().has_value());
}

TEST_F(TumSourceTest, AcceptsJpegAndGrayColourImages) {
  writer_.color(1.0, color_image(90), ".jpg");
  writer_.color(2.0, cv::Mat(kImageHeight, kImageWidth, CV_8UC1, cv::Scalar(77)));
  for (const double time : {1.0, 2.0}) writer_.depth(time, depth_image(5000));
  TumSource source = open();
  const auto frames = frames_of(source);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_NEAR(frames[0].bgr.at<cv::Vec3b>(5, 7)[0], 90, 3);
  EXPECT_EQ(frames[1].bgr.at<cv::Vec3b>(5, 7), cv::Vec3b(77, 77, 77));
}

TEST_F(TumSourceTest, SelectsPairs) {
  write(10);
  auto options = options_for(folder_.path());
  options.selection.start = 1;
  options.selection.end = 8;
  options.selection.stride = 3;
  TumSource source = open(options);
  EXPECT_EQ(source.size(), 3u);
  EXPECT_NEAR(frames_of(source).back().time, 1.7, 1e-9);
  options.selection.limit = 2;
  EXPECT_EQ(open(options).size(), 2u);
  options.selection.start = 8;
  EXPECT_THAT(error_text(Fault::kUsage, [&] { open(options); }),
              HasSubstr("no frames are selected of the 10 pairs"));
}

TEST_F(TumSourceTest, AsksForACamera) {
  write(1);
  writer_.finish();
  EXPECT_THAT(
      error_text(Fault::kUsage, [&] { TumSource(options_for(folder_.path()), StageContext{}); }),
      AllOf(HasSubstr("no camera is given"), HasSubstr("configs/cameras"), HasSubstr("--camera")));
}

TEST_F(TumSourceTest, SkipsAMissingImage) {
  write(5);
  std::filesystem::remove(color_files_[2]);
  expect_skipped("no such file");
}

TEST_F(TumSourceTest, SkipsAnEmptyFile) {
  write(5);
  std::filesystem::resize_file(depth_files_[2], 0);
  expect_skipped("the file is empty");
}

TEST_F(TumSourceTest, SkipsATruncatedImage) {
  write(5);
  truncate_file(color_files_[2], 0.6);
  expect_skipped("truncated PNG");
}

TEST_F(TumSourceTest, SkipsATruncatedJpeg) {
  write(5);
  cv::Mat noise(kImageHeight, kImageWidth, CV_8UC3);
  cv::randu(noise, 0, 256);
  std::vector<std::uint8_t> bytes = encode_image(".jpg", noise);
  folder_.write("rgb/1.200000.png", std::string(bytes.begin(), bytes.begin() + bytes.size() / 2));
  expect_skipped("truncated JPEG");
}

// Small files whose headers state gigapixels.
void expect_too_large(const std::filesystem::path& file) {
  try {
    ImageReader().color(file);
    FAIL() << "decoded";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("an image of 32000 x 32000 pixels is more than"));
  }
}

TEST_F(TumSourceTest, DecodesNoPngThatIsTooLarge) {
  std::vector<std::uint8_t> bytes = encode_image(".png", color_image(7));
  for (const std::size_t side : {16, 20}) {  // four bytes each
    bytes[side + 2] = 32000 >> 8;
    bytes[side + 3] = 32000 & 255;
  }
  expect_too_large(folder_.write("big.png", std::string(bytes.begin(), bytes.end())));
}

TEST_F(TumSourceTest, DecodesNoJpegThatIsTooLarge) {
  std::vector<std::uint8_t> bytes = encode_image(".jpg", color_image(7));
  constexpr std::uint8_t kFrameHeader[] = {0xff, 0xc0};
  const auto frame =
      std::search(bytes.begin(), bytes.end(), std::begin(kFrameHeader), std::end(kFrameHeader));
  ASSERT_GT(bytes.end() - frame, 9);
  for (const int side : {5, 7}) {  // two bytes each
    frame[side] = 32000 >> 8;
    frame[side + 1] = 32000 & 255;
  }
  expect_too_large(folder_.write("big.jpg", std::string(bytes.begin(), bytes.end())));
}

TEST_F(TumSourceTest, SkipsAFileTooLargeToBeAnImage) {
  write(5);
  std::filesystem::resize_file(depth_files_[2], 20ULL << 30);  // sparse
  expect_skipped("has 20480 MiB; such a file has at most 256");
}

TEST_F(TumSourceTest, SkipsAPipe) {
  write(5);
  std::filesystem::remove(color_files_[2]);
  ASSERT_EQ(::mkfifo(color_files_[2].c_str(), 0600), 0);
  expect_skipped("is no regular file");
}

TEST_F(TumSourceTest, SkipsWhatIsNoImage) {
  write(5);
  folder_.write("rgb/1.200000.png", "Not Found");
  expect_skipped("is not an image");
}

TEST_F(TumSourceTest, SkipsAnEightBitDepthImage) {
  write(5);
  testing::write_image(depth_files_[2], cv::Mat(kImageHeight, kImageWidth, CV_8UC1, cv::Scalar(9)));
  expect_skipped(
      "a depth image must be 16-bit with 1 channel, this is an 8-bit image with 1 channel");
}

TEST_F(TumSourceTest, SkipsASixteenBitGrayColourImage) {
  write(5);
  testing::write_image(color_files_[2], depth_image(9));
  expect_skipped("check that colour and depth are not exchanged");
}

TEST_F(TumSourceTest, SkipsAnImageOfTheWrongSize) {
  write(5);
  testing::write_image(depth_files_[2], cv::Mat(24, 32, CV_16UC1, cv::Scalar(9)));
  expect_skipped("the image has 32 x 24 pixels, but camera 'tiny' has 64 x 48");
}

TEST_F(TumSourceTest, SkipsDepthWithoutMeasurements) {
  write(5);
  testing::write_image(depth_files_[2], depth_image(0));
  expect_skipped("the depth image has no measurement");
}

TEST_F(TumSourceTest, GivesUpWhenTheFirstTenPairsFail) {
  write(30);
  for (int i = 0; i < 10; ++i) truncate_file(color_files_[i], 0.5);
  TumSource source = open();
  EXPECT_THAT(error_text(Fault::kData, [&] { source.next(); }),
              AllOf(HasSubstr("none of the first 10 image pairs can be used"),
                    HasSubstr(color_files_[9].string() + ": truncated PNG")));
}

TEST_F(TumSourceTest, GivesUpWhenMoreThanHalfFail) {
  write(8);
  for (int i = 1; i < 6; ++i) std::filesystem::remove(depth_files_[i]);
  TumSource source = open();
  EXPECT_THAT(error_text(Fault::kData, [&] { frames_of(source); }),
              AllOf(HasSubstr("more than half of the 8 image pairs cannot be used"),
                    HasSubstr("no such file")));
}

TEST_F(TumSourceTest, GivesUpWhenNoFrameHasDepth) {
  for (int i = 0; i < 4; ++i) writer_.pair(1.0 + i, color_image(i), depth_image(0));
  TumSource source = open();
  EXPECT_THAT(error_text(Fault::kData, [&] { source.next(); }),
              HasSubstr("the depth image has no measurement"));
}

TEST_F(TumSourceTest, ReportsOnlyTheFirstOfManySkippedImages) {
  write(100);
  for (int i = 1; i < 50; ++i) std::filesystem::remove(depth_files_[i]);
  TumSource source = open();
  EXPECT_EQ(frames_of(source).size(), 51u);
  EXPECT_EQ(source.report().skipped, 49u);
  EXPECT_EQ(source.report().warnings.size(), 21u);
}

TEST(TumSourceOnRealData, ReadsFreiburg1Xyz) {
  const std::filesystem::path folder = testing::shared_data() / "data/tum_fr1_xyz";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";

  StageContext context;
  context.camera = CameraModel{.name = "tum_fr1",
                               .fx = 517.306408,
                               .fy = 516.469215,
                               .cx = 318.643040,
                               .cy = 255.313989,
                               .distortion = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}};
  auto options = options_for(folder);
  EXPECT_EQ(TumSource(options, context).size(), 792u);
  const Recording by_time = open_recording(folder);
  const Recording associated = open_recording(folder, {.prefer = PairsFrom::kAssociations});
  ASSERT_EQ(by_time.pairs.size(), associated.pairs.size());
  for (std::size_t i = 0; i < by_time.pairs.size(); ++i) {
    EXPECT_EQ(by_time.pairs[i].color.file, associated.pairs[i].color.file);
    EXPECT_EQ(by_time.pairs[i].depth.file, associated.pairs[i].depth.file);
  }

  options.selection.limit = 3;
  TumSource source(options, context);
  const auto frame = source.next();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->bgr.size(), cv::Size(640, 480));
  EXPECT_EQ(frame->depth.type(), CV_32FC1);
  EXPECT_GT(cv::countNonZero(frame->depth), 640 * 480 / 2);
  EXPECT_EQ(source.ground_truth(), folder / "groundtruth.txt");
}

}  // namespace
}  // namespace stillpoint::source_tum
