#include "stillpoint/runtime/output_stage.hpp"

#include <gtest/gtest.h>

#include <latch>

#include "doubles.hpp"

namespace stillpoint {
namespace {

using testing::CallLog;
using Strings = std::vector<std::string>;

constexpr std::uint32_t kMany = 100;  // more than wait in the queue

struct OutputFixture {
  CallLog calls;
  StopSignal stop;
  TimeLog times;
  std::shared_ptr<testing::FakeOutput> output = std::make_shared<testing::FakeOutput>(calls);

  std::unique_ptr<OutputStage> make(Mode mode, WhenFull when_full = WhenFull::kWait) {
    return std::make_unique<OutputStage>(std::vector<Stage<Output>>{{output, "viewer"}}, when_full,
                                         mode, stop, times);
  }
  static FrameReportPtr report(std::uint32_t index) {
    return std::make_shared<const FrameReport>(
        FrameReport{.frame = std::make_shared<const Frame>(testing::make_frame(index))});
  }
  std::size_t written() { return calls.entries("output").size(); }
};

class OutputStageInBothModes : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Modes, OutputStageInBothModes,
                         ::testing::Values(Mode::kInline, Mode::kThreaded), [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

TEST_P(OutputStageInBothModes, GetsEveryFrameInOrderAndIsMeasured) {
  OutputFixture f;
  const auto stage = f.make(GetParam());
  Strings expected;
  for (std::uint32_t i = 0; i < kMany; ++i) {
    stage->frame(f.report(i));
    expected.push_back("output " + std::to_string(i));
  }
  stage->end();
  EXPECT_EQ(f.calls.entries("output"), expected);
  EXPECT_EQ(stage->dropped(), 0);
  const std::vector<StageTime> times = f.times.take();
  ASSERT_EQ(times.size(), kMany);
  EXPECT_EQ(times.back().stage, "outputs");
  EXPECT_EQ(times.back().frame, kMany - 1);
}

TEST_P(OutputStageInBothModes, AFailureIsNamedAndEndsTheRun) {
  OutputFixture f;
  f.calls.failing = "output 1";
  const auto stage = f.make(GetParam());
  const auto write_all = [&] {
    for (std::uint32_t i = 0; i < kMany; ++i) stage->frame(f.report(i));
    stage->end();
    if (const auto failure = f.stop.failure()) std::rethrow_exception(failure);
  };
  try {
    write_all();
    FAIL() << "no exception";
  } catch (const StageError& error) {
    EXPECT_STREQ(error.what(), "output (viewer) failed on frame 1: out of ideas");
  }
  EXPECT_EQ(f.written(), 2u);
}

// The output blocks on its first frame until it is released.
struct BlockedOutput : OutputFixture {
  BlockedOutput() {
    calls.hook = [this](const std::string& entry) {
      if (entry == "output 0") release.wait();
    };
  }
  std::latch release{1};
};

TEST(OutputStage, ASlowOneMissesFramesWhereItMay) {
  BlockedOutput f;
  const auto stage = f.make(Mode::kThreaded, WhenFull::kDrop);
  stage->frame(f.report(0));
  f.calls.wait_for("output 0");
  for (std::uint32_t i = 1; i < kMany; ++i) stage->frame(f.report(i));  // would wait for ever
  f.release.count_down();
  stage->end();
  EXPECT_GT(stage->dropped(), 0);
  EXPECT_EQ(f.written() + static_cast<std::size_t>(stage->dropped()), kMany);
  EXPECT_TRUE(f.calls.contains("output 99")) << "the newest are kept";
}

TEST(OutputStage, ASlowOneIsWaitedForWhereItMayNotMissFrames) {
  BlockedOutput f;
  const auto stage = f.make(Mode::kThreaded);
  std::jthread tracking([&] {
    for (std::uint32_t i = 0; i < kMany; ++i) stage->frame(f.report(i));
  });
  f.calls.wait_for("output 0");
  f.release.count_down();
  tracking.join();
  stage->end();
  EXPECT_EQ(f.written(), kMany);
}

TEST(OutputStage, AStopEndsTheWaitForABlockedOneAndWhatWaitsIsWritten) {
  BlockedOutput f;
  const auto stage = f.make(Mode::kThreaded);
  std::jthread tracking([&] {
    for (std::uint32_t i = 0; i < kMany; ++i) stage->frame(f.report(i));
  });
  f.calls.wait_for("output 0");
  f.stop.request();
  tracking.join();
  f.release.count_down();
  stage->end();
  EXPECT_GE(f.written(), 2u);
}

}  // namespace
}  // namespace stillpoint
