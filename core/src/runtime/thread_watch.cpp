#include "stillpoint/engine/thread_watch.hpp"

#include <signal.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "stillpoint/engine/stage_error.hpp"
#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/runtime/plugin_thread.hpp"

namespace stillpoint {
namespace {

// Calls that were under way may wait for the thread, and so may those that save results. What is
// ended leaves its locks behind, hence some patience.
constexpr std::chrono::seconds kTimeToReturn{2};
constexpr std::chrono::seconds kTimeToSave{10};

std::optional<StageError> error_of_stopped_thread() {
  const auto ended = end_of_stopped_thread();
  if (!ended) return std::nullopt;
  return StageError(ended->thread(), std::nullopt, &*ended);
}

void watch_threads(const std::stop_token& stop, StoppedThreadWait& for_threads,
                   const ThreadWatch::Ended& ended) {
  for_threads.wait();
  if (stop.stop_requested()) return;
  const auto end_of_thread = std::chrono::steady_clock::now();
  ended(std::make_exception_ptr(*error_of_stopped_thread()));
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  const auto wait = [&](std::chrono::seconds time) {
    stopped.wait_for(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
  };
  if (wait(kTimeToReturn)) StageGuard::give_up(end_of_thread);
  while (wait(kTimeToSave)) StageGuard::give_up(std::chrono::steady_clock::now() - kTimeToSave);
}

/// Signals are for threads that wait for them.
std::jthread without_signals(std::function<void(const std::stop_token&)> function) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::jthread thread(std::move(function));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace

ThreadWatch::ThreadWatch(Ended ended) {
  if (!StageGuard::exists()) return;
  wait_ = std::make_unique<StoppedThreadWait>();
  if (!wait_->possible()) return;
  watcher_ = without_signals([this, ended = std::move(ended)](const std::stop_token& stop) {
    watch_threads(stop, *wait_, ended);
  });
  wait_->begin();
}

ThreadWatch::~ThreadWatch() {
  if (!watcher_.joinable()) return;
  watcher_.request_stop();
  wait_->end();
}

std::string ThreadWatch::failure_text() {
  const auto error = error_of_stopped_thread();
  return error ? error->what() : std::string();
}

}  // namespace stillpoint
