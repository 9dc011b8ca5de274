// Asks the work that a stage is doing to end early.
#pragma once

#include <mutex>
#include <stop_token>

namespace stillpoint {

/// Any thread may ask; it concerns the work under way, not what comes after it.
class EarlyEnd {
 public:
  /// For work that begins now; `already` asks at once.
  std::stop_token begin(bool already) {
    const std::lock_guard lock(mutex_);
    source_ = std::stop_source();
    if (already) source_.request_stop();
    return source_.get_token();
  }
  void request() {
    const std::lock_guard lock(mutex_);
    source_.request_stop();
  }

 private:
  std::mutex mutex_;
  std::stop_source source_;  // guarded by mutex_
};

}  // namespace stillpoint
