#include "live_camera/sensor_clock.hpp"

#include <gtest/gtest.h>

namespace stillpoint::live_camera {
namespace {

constexpr double kMegahertz = 1e6;
constexpr double kExact = 2e-5;  // seconds

TEST(SensorClock, KeepsTheDevicesIntervalsWhateverTheArrival) {
  SensorClock clock(kMegahertz, 64);
  EXPECT_DOUBLE_EQ(clock.seconds(5'000'000, 100.0), 100.0);
  EXPECT_NEAR(clock.seconds(5'033'333, 100.041), 100.033333, kExact);
  EXPECT_NEAR(clock.seconds(5'066'667, 100.070), 100.066667, kExact);
  EXPECT_EQ(clock.jumps(), 0);
}

TEST(SensorClock, TakesTheStreamsOutOfOrder) {
  SensorClock clock(kMegahertz, 32);
  clock.seconds(1'040'000, 10.040);
  EXPECT_NEAR(clock.seconds(1'033'000, 10.041), 10.033, kExact);
  EXPECT_NEAR(clock.seconds(1'066'000, 10.067), 10.066, kExact);
  EXPECT_EQ(clock.jumps(), 0);
}

TEST(SensorClock, GoesOnWhenTheCounterStartsOver) {
  SensorClock clock(60 * kMegahertz, 32);  // every 71.6 s
  const std::uint64_t before = 0xffffffffu - 1'000'000u;
  clock.seconds(before, 20.0);
  const std::uint64_t after = (before + 2'000'000u) & 0xffffffffu;
  ASSERT_LT(after, before);
  EXPECT_NEAR(clock.seconds(after, 20.035), 20.0 + 1.0 / 30, kExact);
  EXPECT_EQ(clock.jumps(), 0);
}

TEST(SensorClock, ComparesAnewAfterAReset) {
  SensorClock clock(kMegahertz, 64);
  clock.seconds(90'000'000, 200.0);
  EXPECT_DOUBLE_EQ(clock.seconds(33'000, 203.5), 203.5);  // plugged in again
  EXPECT_NEAR(clock.seconds(66'000, 203.54), 203.533, kExact);
  EXPECT_EQ(clock.jumps(), 1);
}

TEST(SensorClock, ARestartIsNoJump) {
  SensorClock clock(kMegahertz, 64);
  clock.seconds(90'000'000, 200.0);
  clock.restart();
  EXPECT_DOUBLE_EQ(clock.seconds(33'000, 203.5), 203.5);
  EXPECT_EQ(clock.jumps(), 0);
}

TEST(SensorClock, FollowsAClockThatRunsFasterOrSlower) {
  for (const double rate : {1 - 1e-4, 1 + 1e-4}) {
    SensorClock clock(kMegahertz, 64);
    double last = 0;
    for (int image = 0; image < 10 * 3600 * 30; ++image) {  // ten hours
      const double taken = image / 30.0;
      const double seconds = clock.seconds(static_cast<std::uint64_t>(taken * rate * kMegahertz),
                                           taken + 0.01 + 0.005 * (image % 3));
      ASSERT_NEAR(seconds, taken, 0.03) << "after " << taken << " s";
      if (image > 0) {
        ASSERT_NEAR(seconds - last, 1 / 30.0, kExact);
      }
      last = seconds;
    }
    EXPECT_EQ(clock.jumps(), 0);
  }
}

TEST(SensorClock, HostTimeIsThatOfTheComputerAndGrows) {
  const double first = host_seconds();
  EXPECT_GT(first, 1.7e9);  // 2023
  EXPECT_GE(host_seconds(), first);
}

}  // namespace
}  // namespace stillpoint::live_camera
