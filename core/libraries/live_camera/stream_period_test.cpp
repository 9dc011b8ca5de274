#include "live_camera/stream_period.hpp"

#include <gtest/gtest.h>

namespace stillpoint::live_camera {
namespace {

StreamPeriod stream_of(double rate, int images = 20) {
  StreamPeriod stream;
  for (int i = 0; i < images; ++i) stream.add(7 + i / rate);
  return stream;
}

TEST(StreamPeriod, IsNotKnownOfOneImage) {
  EXPECT_FALSE(stream_of(30, 1).seconds());
  EXPECT_NEAR(stream_of(30, 2).seconds().value(), 1 / 30.0, 1e-9);
}

TEST(StreamPeriod, IsThatBetweenTheGaps) {
  StreamPeriod stream;
  for (const int i : {0, 2, 4, 5, 7, 8, 10, 12}) stream.add(i / 60.0);
  EXPECT_NEAR(stream.seconds().value(), 1 / 60.0, 1e-9);
}

// Stamps of arrival: images that waited in the driver come at once.
TEST(StreamPeriod, IsNotThatOfABurst) {
  StreamPeriod stream = stream_of(30);
  for (int i = 0; i < 3; ++i) stream.add(9 + 0.001 * i);
  EXPECT_NEAR(stream.seconds().value(), 1 / 30.0, 1e-9);
}

TEST(StreamPeriod, FollowsAClockThatIsSetBack) {
  StreamPeriod stream = stream_of(30);
  for (int i = 0; i < 40; ++i) stream.add(i / 15.0);
  EXPECT_NEAR(stream.seconds().value(), 1 / 15.0, 1e-9);
}

// Of 30 Hz and less, it is what the user says.
TEST(PairingLimit, IsLessThanAnIntervalOfFastStreams) {
  EXPECT_EQ(pairing_limit(0.02, {}, {}), 0.02);
  EXPECT_NEAR(pairing_limit(0.02, stream_of(30), stream_of(30)), 0.02, 1e-9);
  EXPECT_NEAR(pairing_limit(0.02, stream_of(60), {}), 0.01, 1e-9);
  EXPECT_NEAR(pairing_limit(0.02, stream_of(30), stream_of(60)), 0.01, 1e-9);
}

}  // namespace
}  // namespace stillpoint::live_camera
