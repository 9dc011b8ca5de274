#include "ros2_messages/mcap_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "ros2_messages/frames.hpp"
#include "ros2_messages/message_type.hpp"
#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

// tests/mcap reads files by the specification, and with the readers of others.
namespace stillpoint::ros2_messages {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::TemporaryFolder;

constexpr const char* kMagic = "\x89MCAP0\r\n";

class McapWriterTest : public ::testing::Test {
 protected:
  fs::path file() const { return folder_.path() / "test.mcap"; }
  std::string text() const {
    std::ifstream stream(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  TemporaryFolder folder_;
};

TEST_F(McapWriterTest, ASecondOfMessagesIsOnDiskBeforeTheEnd) {
  McapWriter writer(file(), Compression::kNone);
  const ChannelId channel = writer.add_channel<Text>("/words");
  writer.write(channel, 10.0, Text{"the first"});
  writer.write(channel, 10.9, Text{"the second"});
  EXPECT_FALSE(fs::exists(file()));
  writer.write(channel, 11.0, Text{"the third"});
  EXPECT_THAT(text(), AllOf(StartsWith(kMagic), HasSubstr("std_msgs/msg/String"),
                            HasSubstr("the first"), HasSubstr("the third")));
  writer.write(channel, 11.1, Text{"the fourth"});
  EXPECT_THAT(text(), Not(HasSubstr("the fourth")));
  writer.finish();
  EXPECT_THAT(text(), AllOf(HasSubstr("the fourth"), EndsWith(kMagic)));
}

TEST_F(McapWriterTest, LargeMessagesEndAChunk) {
  McapWriter writer(file(), Compression::kNone);
  const ChannelId channel = writer.add_channel<Image>("/image");
  writer.write(channel, 1, Image{{}, cv::Mat::zeros(600, 600, CV_8UC3)});
  EXPECT_GT(text().size(), 600u * 600 * 3);
}

TEST_F(McapWriterTest, FinishesWhenDestroyed) {
  {
    McapWriter writer(file());
    writer.write(writer.add_channel<Text>("/words"), 1, Text{"the last"});
  }
  EXPECT_THAT(text(), AllOf(StartsWith(kMagic), EndsWith(kMagic)));
}

TEST_F(McapWriterTest, LeavesWhatIsThereWithoutMessages) {
  std::ofstream(file()) << "of an earlier run";
  McapWriter(file()).add_channel<Text>("/words");
  EXPECT_EQ(text(), "of an earlier run");
}

std::string message_of_failure(const fs::path& file) {
  McapWriter writer(file);
  const ChannelId channel = writer.add_channel<Text>("/words");
  writer.write(channel, 1, Text{"lost"});
  try {
    writer.finish();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_NO_THROW(writer.write(channel, 100, Text{"ignored"}));
    EXPECT_NO_THROW(writer.finish());  // told once
    return error.what();
  }
  return "no exception";
}

TEST_F(McapWriterTest, SaysOnceThatAFileCannotBeWritten) {
  EXPECT_THAT(message_of_failure("/dev/full"),
              HasSubstr("/dev/full: cannot write: No space left on device; check"));
  EXPECT_THAT(message_of_failure(folder_.path() / "none/test.mcap"),
              HasSubstr("cannot write: No such file or directory"));
}

TEST(Cdr, NumbersStandAtMultiplesOfTheirSize) {
  EXPECT_THAT(cdr_of(Text{"abc"}), ElementsAre(0, 1, 0, 0, 4, 0, 0, 0, 'a', 'b', 'c', 0));
  const Bytes pose = cdr_of(PoseMessage{{1.5, "map"}, Pose(Eigen::Translation3d(1, 2, 3))});
  // Header of 4, stamp of 8, text of 4 + 4, then seven numbers from a multiple of eight.
  ASSERT_EQ(pose.size(), 4u + 16 + 7 * 8);
  double x = 0;
  std::memcpy(&x, &pose[4 + 16], sizeof x);
  EXPECT_EQ(x, 1);
  EXPECT_THAT(Bytes(pose.begin() + 4, pose.begin() + 12),
              ElementsAre(1, 0, 0, 0, 0, 0x65, 0xcd, 0x1d));
}

TEST(Cdr, ACutOutImageIsWrittenWithoutItsSurroundings) {
  cv::Mat whole = cv::Mat::zeros(4, 4, CV_8UC3);
  const cv::Mat part = whole(cv::Rect(1, 1, 2, 2));
  EXPECT_EQ(cdr_of(Image{{}, part}), cdr_of(Image{{}, part.clone()}));
}

TEST(Times, OutsideOfThoseOfRosBecomeTheNearest) {
  EXPECT_EQ(nanoseconds(1.25), 1'250'000'000u);
  EXPECT_EQ(nanoseconds(-5), 0u);
  EXPECT_EQ(nanoseconds(1e300), 2'147'483'647'000'000'000u);
}

TEST(Schema, HoldsEveryTypeOnce) {
  const std::string text = schema_text("nav_msgs/Path");
  EXPECT_EQ(text.find("std_msgs/Header header"), 0u);
  for (const char* type : {"MSG: std_msgs/Header\n", "MSG: builtin_interfaces/Time\n",
                           "MSG: geometry_msgs/PoseStamped\n", "MSG: geometry_msgs/Quaternion\n"}) {
    const std::size_t at = text.find(type);
    ASSERT_NE(at, std::string::npos) << type;
    EXPECT_EQ(text.find(type, at + 1), std::string::npos) << type;
  }
  EXPECT_EQ(schema_name("nav_msgs/Path"), "nav_msgs/msg/Path");
}

TEST(Frames, TheMapHasItsZAxisUp) {
  const Pose pose = map_from_world();
  EXPECT_EQ(pose * Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0));   // forward
  EXPECT_EQ(pose * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0));  // right
  EXPECT_EQ(pose * Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, -1));  // down
}

}  // namespace
}  // namespace stillpoint::ros2_messages
