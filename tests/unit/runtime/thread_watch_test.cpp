// Threads of plugins that crash, where several runs are watched: each test is a process of its own,
// in which this program counts as a plugin.
#include "stillpoint/engine/thread_watch.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "stillpoint/engine/stage_guard.hpp"

namespace stillpoint {
namespace {

constexpr std::chrono::seconds kPatience{20};
constexpr char kOfThisProgram = 0;

void crash_in_a_thread() {
  std::thread([] { std::raise(SIGSEGV); }).detach();
}

std::string text_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// A watch, and what it is told.
class Watched {
 public:
  bool is_told() {
    auto told = told_.get_future();
    return told.wait_for(kPatience) == std::future_status::ready &&
           told.get().find("it crashed: SIGSEGV") != std::string::npos;
  }

 private:
  std::promise<std::string> told_;
  ThreadWatch watch_{
      [this](const std::exception_ptr& failure) { told_.set_value(text_of(failure)); }};
};

TEST(ThreadWatchDeathTest, AllAreToldOfAThreadThatCrashed) {
  const auto run = [] {
    const StageGuard guard;
    StageGuard::library_was_loaded(&kOfThisProgram);
    Watched one, other;
    crash_in_a_thread();
    return one.is_told() && other.is_told();
  };
  EXPECT_EXIT(std::_Exit(run() ? 0 : 1), ::testing::ExitedWithCode(0), "");
}

// As by `engine = Engine(…)`.
TEST(ThreadWatchDeathTest, WhoReplacesAnotherIsTold) {
  const auto run = [] {
    const StageGuard guard;
    StageGuard::library_was_loaded(&kOfThisProgram);
    auto watched = std::make_unique<Watched>();
    watched = std::make_unique<Watched>();
    crash_in_a_thread();
    return watched->is_told();
  };
  EXPECT_EXIT(std::_Exit(run() ? 0 : 1), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace stillpoint
