#include "stillpoint/runtime/beside_tracking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <latch>
#include <stdexcept>
#include <string>

namespace stillpoint {
namespace {

struct Fixture {
  StopSignal stop;
  TimeLog times;
};

class BesideTrackingInBothModes : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Modes, BesideTrackingInBothModes,
                         ::testing::Values(Mode::kInline, Mode::kThreaded), [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

TEST_P(BesideTrackingInBothModes, ALaterCallUsesWhatAnEarlierOneGave) {
  Fixture f;
  BesideTracking beside(GetParam(), f.stop, f.times);
  for (std::uint32_t frame = 0; frame < 20; ++frame) {
    const auto number = beside.start([frame] { return frame + 1; });
    const auto text = beside.start([number] { return std::to_string(*number); });
    ASSERT_TRUE(beside.wait(frame));
    EXPECT_EQ(*number, frame + 1);
    EXPECT_EQ(text->front(), std::to_string(frame + 1).front());
  }
}

TEST(BesideTracking, InlineCallsNothingBeforeItIsWaitedFor) {
  Fixture f;
  BesideTracking beside(Mode::kInline, f.stop, f.times);
  bool called = false;
  beside.start([&called] { return called = true; });
  EXPECT_FALSE(called);
  EXPECT_TRUE(beside.wait(0));
  EXPECT_TRUE(called);
  EXPECT_TRUE(f.times.take().empty());
}

TEST(BesideTracking, ThreadedRunsBesideItsCaller) {
  Fixture f;
  BesideTracking beside(Mode::kThreaded, f.stop, f.times);
  std::latch called(1);
  const auto id = beside.start([&called] {
    called.count_down();
    return std::this_thread::get_id();
  });
  called.wait();
  ASSERT_TRUE(beside.wait(0));
  EXPECT_NE(*id, std::this_thread::get_id());
}

TEST(BesideTracking, InlineTheCallerGetsTheFailure) {
  Fixture f;
  BesideTracking beside(Mode::kInline, f.stop, f.times);
  bool called = false;
  beside.start([]() -> int { throw std::runtime_error("out of ideas"); });
  beside.start([&called] { return called = true; });
  EXPECT_THROW(beside.wait(0), std::runtime_error);
  EXPECT_FALSE(called);
  EXPECT_TRUE(beside.wait(1)) << "what did not run with the frame that failed is forgotten";
  EXPECT_FALSE(called);
}

TEST(BesideTracking, ThreadedAFailureStopsTheRun) {
  Fixture f;
  BesideTracking beside(Mode::kThreaded, f.stop, f.times);
  beside.start([]() -> int { throw std::runtime_error("out of ideas"); });
  EXPECT_FALSE(beside.wait(0));
  ASSERT_TRUE(f.stop.failure());
  EXPECT_THROW(std::rethrow_exception(f.stop.failure()), std::runtime_error);
}

TEST(BesideTracking, AStopEndsTheWait) {
  Fixture f;
  std::latch called(1);
  std::latch release(1);  // used by the thread of the next until that has ended
  BesideTracking beside(Mode::kThreaded, f.stop, f.times);
  beside.start([&] {
    called.count_down();
    release.wait();
    return true;
  });
  called.wait();
  f.stop.request();
  EXPECT_FALSE(beside.wait(0));
  release.count_down();
}

TEST(BesideTracking, WaitingIsMeasured) {
  Fixture f;
  BesideTracking beside(Mode::kThreaded, f.stop, f.times);
  beside.start([] { return true; });
  ASSERT_TRUE(beside.wait(7));
  const std::vector<StageTime> times = f.times.take();
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times.front().stage, "beside_wait");
  EXPECT_EQ(times.front().frame, 7u);
}

}  // namespace
}  // namespace stillpoint
