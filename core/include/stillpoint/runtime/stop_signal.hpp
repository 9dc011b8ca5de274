// Ends a run early, for everybody at once.
#pragma once

#include <exception>
#include <mutex>
#include <stop_token>
#include <utility>

namespace stillpoint {

/// Shared by all threads of a run: one stop source that wakes every wait, and the first failure.
class StopSignal {
 public:
  std::stop_token token() const { return source_.get_token(); }
  bool requested() const { return source_.stop_requested(); }
  void request() { source_.request_stop(); }

  /// Keeps the first failure; those that it causes elsewhere say nothing new.
  void fail(std::exception_ptr failure) {
    {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::move(failure);
    }
    source_.request_stop();
  }
  std::exception_ptr failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
  }

 private:
  std::stop_source source_;
  mutable std::mutex mutex_;
  std::exception_ptr failure_;  // guarded by mutex_
};

}  // namespace stillpoint
