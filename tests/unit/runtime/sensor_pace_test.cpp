// `pace: sensor`, with a clock that the test turns.
#include <gtest/gtest.h>

#include <condition_variable>
#include <latch>
#include <mutex>
#include <thread>

#include "engine_fixture.hpp"

namespace stillpoint {
namespace {

using testing::EngineFixture;
using testing::runtime;
using Pace = RuntimeOptions::Pace;
using Strings = std::vector<std::string>;

class SensorPace : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Modes, SensorPace, ::testing::Values(Mode::kInline, Mode::kThreaded),
                         [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

/// Stands still until a test lets it go on.
class ManualClock final : public PaceClock {
 public:
  double now() override {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  void wait_until(double time, std::stop_token stop) override {
    std::unique_lock lock(mutex_);
    waits_for_ = time;
    changed_.notify_all();
    changed_.wait(lock, std::move(stop), [&] { return now_ >= time - 1e-9 || waits_to_end_ > 0; });
    if (now_ >= time - 1e-9) return;
    now_ = time;
    --waits_to_end_;
  }
  void set(double time) {
    const std::lock_guard lock(mutex_);
    now_ = time;
    changed_.notify_all();
  }
  /// The clock goes to whatever is waited for, now or next.
  void end_one_wait() {
    const std::lock_guard lock(mutex_);
    ++waits_to_end_;
    changed_.notify_all();
  }
  /// Returns when all frames due by `time` have been delivered and the next one is waited for.
  void advance(double time) {
    set(time);
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return waits_for_ > time; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  double now_ = 0.0;
  double waits_for_ = -1.0;
  int waits_to_end_ = 0;
};

TEST_P(SensorPace, TwoFramesWaitAndTheOldestMakesRoom) {
  EngineFixture f(9);  // 0.1 s apart
  auto clock = std::make_unique<ManualClock>();
  ManualClock* time = clock.get();
  f.calls.hook = [&](const std::string& entry) {
    // Frame 1 comes when frame 0 is through, the others by the clock from then on.
    if (entry == "track 1") time->advance(0.45);   // 4 and 5 wait, 2 and 3 had to go
    if (entry == "output 5") time->advance(0.65);  // 6 and 7 wait
    if (entry == "output 7") time->set(0.75);      // frame 8, the last
  };
  Engine(f.stages(), runtime(GetParam(), Pace::kSensor), {}, std::move(clock)).run();
  EXPECT_EQ(f.calls.entries("track"),
            (Strings{"track 0", "track 1", "track 4", "track 5", "track 6", "track 7", "track 8"}));
  EXPECT_EQ(f.output->dropped, 2);
}

// It takes as long as several others.
TEST_P(SensorPace, WhileTheFirstFrameIsProcessedTheRecordingWaits) {
  EngineFixture f(4);
  auto clock = std::make_unique<ManualClock>();
  ManualClock* time = clock.get();
  double read = 0.0;
  f.calls.hook = [&](const std::string& entry) {
    if (entry == "track 0") time->set(10);
    if (entry.starts_with("output")) time->end_one_wait();
    if (entry == "source 1") read = time->now();
  };
  Engine(f.stages(), runtime(GetParam(), Pace::kSensor), {}, std::move(clock)).run();
  EXPECT_EQ(f.calls.entries("track").size(), 4u);
  EXPECT_EQ(f.output->dropped, 0);
  EXPECT_EQ(read, 10.0);
}

/// Keeps the run that it is of.
class RunKeeper final : public Output {
 public:
  void begin(const std::shared_ptr<LiveRun>& run) override { kept = run; }
  std::shared_ptr<LiveRun> kept;
};

TEST_P(SensorPace, WhilePausedTheRecordingWaitsAndNothingIsDropped) {
  EngineFixture f(5);
  auto clock = std::make_unique<ManualClock>();
  ManualClock* time = clock.get();
  const auto keeper = std::make_shared<RunKeeper>();
  Stages stages = f.stages();
  stages.outputs.push_back({{keeper, "keeper"}});
  LiveRun::Pause pause;
  std::latch paused(1);
  f.calls.hook = [&](const std::string& entry) {
    if (entry != "output 0") return;
    pause = keeper->kept->pause();
    paused.count_down();
    time->end_one_wait();
  };
  std::thread viewer([&] {
    paused.wait();  // in mode threaded, frame 2 may have been read before
    f.calls.wait_for("source 2");
    time->set(100);                // all are due
    f.calls.wait_for("source 4");  // 1 is to be tracked next, 2 and 3 wait, there is no room for 4
    pause.reset();
  });
  Engine(std::move(stages), runtime(GetParam(), Pace::kSensor), {}, std::move(clock)).run();
  viewer.join();
  EXPECT_EQ(f.calls.entries("track").size(), 5u);
  EXPECT_EQ(f.output->dropped, 0);
}

/// Its clock is set two days on after the third frame.
class SetClock final : public Source {
 public:
  std::optional<Frame> next() override {
    if (next_ == 6) return std::nullopt;
    Frame frame = testing::make_frame(next_++);
    if (frame.index >= 3) frame.time += 2 * 86400;
    return frame;
  }

 private:
  std::uint32_t next_ = 0;
};

TEST_P(SensorPace, AClockThatWasSetIsNotWaitedFor) {
  EngineFixture f;
  f.source = std::make_shared<SetClock>();
  auto clock = std::make_unique<ManualClock>();
  clock->set(100);
  ManualClock* time = clock.get();
  double latest = 0.0;
  f.calls.hook = [&](const std::string& entry) {
    if (!entry.starts_with("output") || entry == "output 0") return;
    latest = time->now();
    time->end_one_wait();
  };
  Engine(f.stages(), runtime(GetParam(), Pace::kSensor), {}, std::move(clock)).run();
  EXPECT_EQ(f.calls.entries("track").size(), 6u);
  EXPECT_LT(latest, 101);
  ASSERT_EQ(f.output->source.warnings.size(), 1u);
  EXPECT_THAT(f.output->source.warnings[0], ::testing::HasSubstr("more than an hour, 1 time:"));
}

TEST_P(SensorPace, AStopEndsTheWait) {
  EngineFixture f(8);
  std::stop_source stop;
  f.calls.hook = [&](const std::string& entry) {
    if (entry == "output 0") stop.request_stop();
  };
  Engine(f.stages(), runtime(GetParam(), Pace::kSensor), {}, std::make_unique<ManualClock>())
      .run(stop.get_token());
  EXPECT_EQ(f.output->finished, 1);
}

TEST(SteadyClock, WaitsUntilTheTimeOrAStop) {
  SteadyClock clock;
  const double start = clock.now();
  clock.wait_until(start + 0.001, {});
  EXPECT_GE(clock.now(), start + 0.001);
  std::stop_source stop;
  stop.request_stop();
  clock.wait_until(start + 1e6, stop.get_token());
}

}  // namespace
}  // namespace stillpoint
