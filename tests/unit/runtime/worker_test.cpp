#include "stillpoint/runtime/worker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <latch>
#include <stdexcept>
#include <thread>
#include <vector>

namespace stillpoint {
namespace {

TEST(Worker, InlineHandlesWithinPushOnTheCallersThread) {
  StopSignal stop;
  std::thread::id thread;
  Worker<int> worker(Mode::kInline, 1, stop, [&](int) { thread = std::this_thread::get_id(); });
  worker.push(1);
  EXPECT_EQ(thread, std::this_thread::get_id());
  EXPECT_FALSE(worker.waiting());
}

TEST(Worker, InlineExceptionsReachTheCaller) {
  StopSignal stop;
  Worker<int> worker(Mode::kInline, 1, stop, [](int) { throw std::runtime_error("no"); });
  EXPECT_THROW(worker.push(1), std::runtime_error);
  EXPECT_FALSE(stop.requested());
}

TEST(Worker, ThreadedKeepsTheOrderAndHandlesEverythingBeforeTheEnd) {
  StopSignal stop;
  std::vector<int> handled;
  Worker<int> worker(Mode::kThreaded, 2, stop, [&](int i) { handled.push_back(i); });
  for (int i = 0; i < 100; ++i) worker.push(i);
  worker.end();
  ASSERT_EQ(handled.size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(handled[i], i);
}

TEST(Worker, WaitIdleReturnsWhenTheLastItemHasBeenHandled) {
  StopSignal stop;
  int handled = 0;
  Worker<int> worker(Mode::kThreaded, 8, stop, [&](int) { ++handled; });
  for (int i = 1; i <= 20; ++i) {
    worker.push(i);
    worker.wait_idle();
    EXPECT_EQ(handled, i);  // no race: the worker is idle
  }
}

TEST(Worker, ExceptionOfTheThreadStopsTheRunAndIsKept) {
  StopSignal stop;
  Worker<int> worker(Mode::kThreaded, 1, stop, [](int) { throw std::runtime_error("first"); });
  for (int i = 0; i < 10; ++i) worker.push(i);  // none of these may hang
  worker.end();
  EXPECT_TRUE(stop.requested());
  stop.fail(std::make_exception_ptr(std::runtime_error("second")));
  try {
    std::rethrow_exception(stop.failure());
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "first");
  }
}

TEST(Worker, StopWakesAPushThatWaitsForRoom) {
  StopSignal stop;
  std::latch busy(1);
  std::latch release(1);
  Worker<int> worker(Mode::kThreaded, 1, stop, [&](int) {
    busy.count_down();
    release.wait();
  });
  worker.push(0);
  busy.wait();
  worker.push(1);  // waits in the queue
  std::jthread pusher([&] { worker.push(2); });
  stop.request();
  pusher.join();
  worker.wait_idle();
  release.count_down();
  worker.end();
}

TEST(Worker, ItemsPastTheLimitNeverWait) {
  StopSignal stop;
  std::vector<int> handled;
  std::latch busy(1);
  std::latch release(1);
  Worker<int> worker(Mode::kThreaded, 1, stop, [&](int i) {
    handled.push_back(i);
    if (i == 0) {
      busy.count_down();
      release.wait();
    }
  });
  worker.push(0);
  busy.wait();
  worker.push(1);
  worker.push_past_limit(2);
  worker.push_past_limit(3);
  EXPECT_TRUE(worker.waiting());
  release.count_down();
  worker.end();
  EXPECT_EQ(handled, (std::vector<int>{0, 1, 2, 3}));
}

TEST(Worker, WithoutRoomTheOldestThatWaitsIsDropped) {
  StopSignal stop;
  std::vector<int> handled;
  std::latch busy(1);
  std::latch release(1);
  Worker<int> worker(Mode::kThreaded, 2, stop, [&](int i) {
    handled.push_back(i);
    if (i == 0) {
      busy.count_down();
      release.wait();
    }
  });
  worker.push_or_drop_oldest(0);
  busy.wait();
  for (int i = 1; i < 6; ++i) worker.push_or_drop_oldest(i);  // 3, 4 and 5 find no room
  release.count_down();
  worker.end();
  EXPECT_EQ(handled, (std::vector<int>{0, 4, 5}));
}

TEST(Worker, AHandlerMayPushToItself) {
  StopSignal stop;
  int handled = 0;
  Worker<int>* self = nullptr;
  Worker<int> worker(Mode::kThreaded, 1, stop, [&](int i) {
    ++handled;
    for (int k = 0; k < i; ++k) self->push_past_limit(0);
  });
  self = &worker;
  worker.push(5);
  worker.wait_idle();
  EXPECT_EQ(handled, 6);
}

TEST(WorkerPriority, IsThatOfTheWorkersThreadAlone) {
  const auto nice_value = [] { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); };
  const int mine = nice_value();
  StopSignal stop;
  int background = 0;
  Worker<int> worker(
      Mode::kThreaded, 1, stop, [&](int) { background = nice_value(); },
      ThreadPriority::kBackground);
  worker.push(1);
  worker.end();
  EXPECT_EQ(background, std::min(mine + 10, 19));
  EXPECT_EQ(nice_value(), mine);
}

}  // namespace
}  // namespace stillpoint
