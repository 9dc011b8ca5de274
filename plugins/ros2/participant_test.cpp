#include "ros2/participant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "stillpoint/error.hpp"
#include "support/dds_loopback.hpp"
#include "support/error_text.hpp"

namespace stillpoint::ros2 {
namespace {

using ::testing::AllOf;
using testing::error_text;
using ::testing::HasSubstr;
using testing::loopback_domain;

const Bytes kMessage = {0, 1, 0, 0, 3, 0, 0, 0, 'h', 'i', 0, 0};
constexpr const char* kType = "std_msgs/String";

std::chrono::steady_clock::time_point soon(int milliseconds) {
  return std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
}

TEST(DdsNames, AreThoseOfRos2) {
  EXPECT_EQ(dds_topic("/tf"), "rt/tf");
  EXPECT_EQ(dds_topic("rgb/image_raw"), "rt/rgb/image_raw");
  EXPECT_EQ(dds_type("sensor_msgs/PointCloud2"), "sensor_msgs::msg::dds_::PointCloud2_");
}

TEST(DdsParticipant, ExchangesMessagesInOrder) {
  const Participant participant(loopback_domain());
  const Reader reader(participant, "chatter", kType, 10, true);
  const Writer writer(participant, "/chatter", kType, Kept::kShortly);
  EXPECT_TRUE(writer.wanted());
  EXPECT_EQ(reader.writers(), 1);
  Bytes second = kMessage;
  second[8] = 'H';
  EXPECT_TRUE(writer.write(kMessage));
  EXPECT_TRUE(writer.write(second));
  EXPECT_EQ(reader.take(soon(5000)), kMessage);
  EXPECT_EQ(reader.take(soon(5000)), second);
  EXPECT_EQ(reader.take(soon(1)), std::nullopt);
}

TEST(DdsParticipant, AMessageIsFilledUpToFourBytes) {
  const Participant participant(loopback_domain());
  const Reader reader(participant, "odd", kType, 1, false);
  const Writer writer(participant, "odd", kType, Kept::kShortly);
  writer.write({0, 1, 0, 0, 1, 0, 0, 0, 0});
  EXPECT_EQ(reader.take(soon(5000)), (Bytes{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(DdsParticipant, OldMessagesMakeRoomForNewOnes) {
  const Participant participant(loopback_domain());
  const Reader reader(participant, "busy", kType, 1, true);
  const Writer writer(participant, "busy", kType, Kept::kShortly);
  Bytes last = kMessage;
  last[9] = 'o';
  writer.write(kMessage);
  writer.write(last);
  EXPECT_EQ(reader.take(soon(5000)), last);
  EXPECT_EQ(reader.take(soon(1)), std::nullopt);
}

TEST(DdsParticipant, AnotherTypeIsAnotherTopic) {
  const Participant participant(loopback_domain());
  const Reader reader(participant, "same", "std_msgs/Int32", 1, true);
  const Writer writer(participant, "same", kType, Kept::kLast);
  EXPECT_FALSE(writer.wanted());
  EXPECT_EQ(reader.writers(), 0);
}

TEST(DdsParticipant, RefusesATopicThatIsNone) {
  const Participant participant(loopback_domain());
  EXPECT_THAT(
      error_text(Fault::kUsage, [&] { Writer(participant, "no topic", kType, Kept::kShortly); }),
      AllOf(HasSubstr("no topic: DDS refuses the topic"), HasSubstr("letters, digits")));
}

TEST(DdsParticipant, RefusesADomainThatIsNone) {
  ::setenv("ROS_DOMAIN_ID", "12x", 1);
  EXPECT_THAT(error_text(Fault::kUsage, [] { Participant(-1); }),
              AllOf(HasSubstr("ROS_DOMAIN_ID: '12x' is no domain"), HasSubstr("0 to 232")));
  ::unsetenv("ROS_DOMAIN_ID");
}

}  // namespace
}  // namespace stillpoint::ros2
