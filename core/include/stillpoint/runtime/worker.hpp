// A stage's thread, or no thread: the only difference between the modes of a run.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <thread>
#include <utility>

#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/runtime/bounded_queue.hpp"
#include "stillpoint/runtime/stop_signal.hpp"
#include "stillpoint/runtime/thread_priority.hpp"

namespace stillpoint {

using Mode = RuntimeOptions::Mode;

/// Hands items to a handler, one after the other. `inline`: within push(), whose caller gets the
/// handler's exceptions. `threaded`: on a thread of its own; an exception stops the whole run.
template <class T>
class Worker {
 public:
  using Handler = std::function<void(T)>;

  Worker(Mode mode, std::size_t capacity, StopSignal& stop, Handler handler,
         ThreadPriority priority = ThreadPriority::kTracking)
      : threaded_(mode == Mode::kThreaded),
        stop_(stop),
        handler_(std::move(handler)),
        queue_(capacity) {
    if (threaded_) thread_ = std::jthread([this, priority] { work(priority); });
  }
  ~Worker() { end(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Waits while `capacity` items are waiting.
  void push(T item) {
    if (threaded_)
      queue_.push(std::move(item), stop_.token());
    else
      handler_(std::move(item));
  }
  /// Never waits, even when full: for one edge of a cycle of workers, which could deadlock
  /// otherwise.
  void push_past_limit(T item) {
    if (threaded_)
      queue_.push_past_limit(std::move(item));
    else
      handler_(std::move(item));
  }
  /// Never waits: without room the item that has waited longest is dropped.
  void push_or_drop_oldest(T item) {
    if (threaded_)
      queue_.push_or_drop_oldest(std::move(item));
    else
      handler_(std::move(item));
  }

  bool threaded() const { return threaded_; }
  /// Items that have to wait for others.
  std::size_t size() const { return queue_.size(); }
  bool waiting() const { return size() > 0; }
  /// Waits until everything pushed has been handled. False after a stop.
  bool wait_idle() { return !threaded_ || queue_.wait_idle(stop_.token()); }
  /// Handles what waits, except after a stop, and ends the thread. No push may follow.
  void end() {
    queue_.close();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void work(ThreadPriority priority) {
    set_priority(priority);
    try {
      while (auto item = queue_.pop(stop_.token())) handler_(std::move(*item));
    } catch (...) {
      stop_.fail(std::current_exception());
    }
  }

  const bool threaded_;
  StopSignal& stop_;
  Handler handler_;
  BoundedQueue<T> queue_;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace stillpoint
