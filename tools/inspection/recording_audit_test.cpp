#include "inspection/recording_audit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inspection/audit_report.hpp"
#include "stillpoint/error.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"
#include "support/shared_data.hpp"

namespace stillpoint::inspection {
namespace {

using stillpoint::testing::RecordingWriter;
using stillpoint::testing::stamp_text;
using stillpoint::testing::TemporaryFolder;
using stillpoint::testing::truncate_file;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const cv::Scalar kGrey(140, 140, 140);

class RecordingAuditTest : public ::testing::Test {
 protected:
  /// Pairs at 10 Hz from 1.0 s; half of the depth pixels hold `depth_value`, the others nothing.
  void write(int count, int depth_value = 10000) {
    cv::Mat depth(48, 64, CV_16UC1, cv::Scalar(0));
    depth.rowRange(0, 24) = depth_value;
    for (int i = 0; i < count; ++i) {
      const double time = 1.0 + 0.1 * (count_ + i);
      color_.push_back(writer_.color(time, cv::Mat(48, 64, CV_8UC3, kGrey)));
      depth_.push_back(writer_.depth(time + 0.004, depth));
    }
    count_ += count;
  }
  RecordingAudit audit(AuditOptions options = {}) {
    writer_.finish();
    return audit_recording(folder_.path(), options);
  }

  TemporaryFolder folder_;
  RecordingWriter writer_{folder_.path()};
  int count_ = 0;
  std::vector<std::filesystem::path> color_, depth_;
};

TEST_F(RecordingAuditTest, CountsASoundRecording) {
  write(20);
  std::string truth = "# poses\n";
  for (int i = 0; i < 200; ++i) truth += stamp_text(0.9 + 0.02 * i) + " 0 0 0 0 0 0 1\n";
  folder_.write("groundtruth.txt", truth);
  const RecordingAudit result = audit();
  EXPECT_EQ(result.pairs.images, 20u);
  EXPECT_NEAR(result.color.interval, 0.1, 1e-6);
  EXPECT_NEAR(result.pairs.duration, 1.9, 1e-6);
  EXPECT_THAT(result.pairs.gaps, IsEmpty());
  EXPECT_NEAR(result.mean_difference, 0.004, 1e-6);
  EXPECT_EQ(result.sampled, 20u);
  EXPECT_EQ(result.color_kinds.at("64 x 48, 8 bit, 3 channels, png"), 20);
  EXPECT_EQ(result.depth_kinds.at("64 x 48, 16 bit, 1 channel, png"), 20);
  EXPECT_DOUBLE_EQ(result.depth_values.valid_share(), 0.5);
  EXPECT_EQ(result.depth_values.quantile(0.5), 10000);
  EXPECT_DOUBLE_EQ(result.depth_values.share_between(1.5, 2.5, 5000), 1.0);
  EXPECT_DOUBLE_EQ(result.truth->covered, 1.0);
  EXPECT_FALSE(result.time_offset.known);
  EXPECT_THAT(result.warnings, IsEmpty());
  EXPECT_THAT(
      report_table(result),
      AllOf(HasSubstr("20 images in 1.90 s, 10.0 Hz, no gaps"), HasSubstr("50.0 % of the pixels"),
            HasSubstr("cannot tell: the camera hardly moves"), HasSubstr("No problems found.")));
}

TEST_F(RecordingAuditTest, ReadsNoMoreImagesThanAsked) {
  write(60);
  EXPECT_EQ(audit({.samples = 10}).sampled, 10u);
  EXPECT_EQ(audit({.samples = 1}).sampled, 5u);  // one at each of the places looked at
}

TEST_F(RecordingAuditTest, ListsGapsLongestFirst) {
  write(5);
  count_ += 2;
  write(5);
  count_ += 9;
  write(5);
  writer_.color(9.0, cv::Mat(48, 64, CV_8UC3, kGrey));
  const RecordingAudit result = audit();
  ASSERT_EQ(result.pairs.gaps.size(), 2u);
  EXPECT_NEAR(result.pairs.gaps[0].length, 1.0, 1e-6);
  EXPECT_NEAR(result.pairs.gaps[0].begin, 2.1, 1e-6);
  EXPECT_NEAR(result.pairs.gaps[1].length, 0.3, 1e-6);
  EXPECT_THAT(result.warnings, AllOf(Contains(HasSubstr("1 of 16 colour images have no depth")),
                                     Contains(HasSubstr("no frames for 1.00 s from 2.100 s"))));
}

TEST_F(RecordingAuditTest, CountsUnusableLinesOfTheGroundTruth) {
  write(10);
  folder_.write("groundtruth.txt",
                "1.0 0 0 0 0 0 0 1\n1.1 nan 0 0 0 0 0 1\n1.2 0 0\n1.2 0 0 0 0 0 0 1\n");
  const RecordingAudit result = audit();
  EXPECT_EQ(result.truth->poses, 2u);
  EXPECT_EQ(result.truth->unusable_lines, 2u);
  EXPECT_DOUBLE_EQ(result.truth->covered, 0.2);
  EXPECT_THAT(result.warnings,
              AllOf(Contains(AllOf(HasSubstr("2 lines of the ground truth are unusable"),
                                   HasSubstr("groundtruth.txt:2"))),
                    Contains(HasSubstr("ground truth covers 20.0 % of the frames"))));
}

TEST_F(RecordingAuditTest, TellsOfWrongExposure) {
  write(7);
  const auto add = [this](const cv::Mat& color) {
    const double time = 1.0 + 0.1 * count_++;
    writer_.pair(time, color, cv::Mat(48, 64, CV_16UC1, cv::Scalar(10000)));
  };
  cv::Mat half_white(48, 64, CV_8UC3, kGrey);
  half_white.rowRange(0, 24) = cv::Scalar::all(255);
  cv::Mat lamp(48, 64, CV_8UC3, cv::Scalar::all(30));
  lamp(cv::Rect(0, 0, 4, 4)) = cv::Scalar::all(255);  // half a percent
  add(half_white);
  add(lamp);
  add(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(0)));
  EXPECT_THAT(audit().warnings,
              AllOf(Contains(HasSubstr("2 of 10 sampled colour images are dark")),
                    Contains(HasSubstr("1 of 10 sampled colour images are over-exposed"))));
}

TEST_F(RecordingAuditTest, DoubtsTheDepthFactor) {
  write(10, 2000);  // millimetres
  EXPECT_THAT(audit().warnings, Contains(AllOf(HasSubstr("half of it is nearer than 0.40 m"),
                                               HasSubstr("with 1000 the median would be 2.00 m"))));
}

TEST_F(RecordingAuditTest, ComparesImagesWithTheCamera) {
  write(10);
  const RecordingAudit result = audit({.camera = CameraModel{.name = "vga"}});
  EXPECT_THAT(result.warnings,
              Contains(HasSubstr("10 sampled images are 64 x 48, 8 bit, 3 channels, png, but "
                                 "camera 'vga' has 640 x 480")));
}

TEST_F(RecordingAuditTest, ReportsImagesThatCannotBeUsed) {
  write(10);
  truncate_file(color_[3], 0.5);
  std::filesystem::remove(depth_[4]);
  testing::write_image(depth_[5], cv::Mat::zeros(48, 64, CV_16UC1));
  const RecordingAudit result = audit();
  ASSERT_EQ(result.unreadable.size(), 2u);
  EXPECT_THAT(result.warnings,
              AllOf(Contains(AllOf(HasSubstr("2 of 20 sampled images cannot be used; first: "),
                                   HasSubstr("truncated PNG"))),
                    Contains(HasSubstr("1 of 9 sampled depth images hold no measurement"))));
}

TEST_F(RecordingAuditTest, IsWrittenAsJson) {
  write(3);
  const auto json = nlohmann::json::parse(report_json(audit()).dump());
  EXPECT_EQ(json["pairs"]["images"], 3);
  EXPECT_EQ(json["depth_values"]["valid_share"], 0.5);
  EXPECT_EQ(json["time_offset"]["known"], false);
  EXPECT_TRUE(json["ground_truth"].is_null());
}

TEST(RecordingAuditOnRealData, AuditsFreiburg1Xyz) {
  const std::filesystem::path folder = stillpoint::testing::shared_data() / "data/tum_fr1_xyz";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const TimeOffset as_recorded = audit_recording(folder, {}).time_offset;
  const RecordingAudit shifted =
      audit_recording(folder, {.pairing = {.max_difference = 0.04, .time_offset = 0.030}});
  ASSERT_TRUE(as_recorded.known);
  ASSERT_TRUE(shifted.time_offset.known);
  EXPECT_NEAR(shifted.time_offset.offset, as_recorded.offset - 0.030, 0.006);
  EXPECT_NEAR(shifted.depth_values.quantile(0.5) / 5000.0, 0.97, 0.05);
  EXPECT_GT(shifted.truth->covered, 0.99);
}

}  // namespace
}  // namespace stillpoint::inspection
