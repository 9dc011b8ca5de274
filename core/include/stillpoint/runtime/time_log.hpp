// Measures what stages cost, on whatever thread they run.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <vector>

#include "stillpoint/contracts/output.hpp"

namespace stillpoint {

/// Times that have not been reported yet, of all threads.
class TimeLog {
 public:
  void add(StageTime time);
  std::vector<StageTime> take();

 private:
  std::mutex mutex_;
  std::vector<StageTime> times_;  // guarded by mutex_
};

/// Adds the time from its construction to its end, unless discarded. Both must be on the same
/// thread.
class ScopedTime {
 public:
  ScopedTime(TimeLog& log, const char* stage, std::uint32_t frame);
  ~ScopedTime();
  ScopedTime(const ScopedTime&) = delete;
  ScopedTime& operator=(const ScopedTime&) = delete;

  void discard() { discarded_ = true; }

 private:
  TimeLog& log_;
  const char* stage_;
  std::uint32_t frame_;
  std::chrono::steady_clock::time_point wall_start_;
  double cpu_start_;  // seconds
  bool discarded_ = false;
};

double thread_cpu_seconds();   ///< processor time of the calling thread
double process_cpu_seconds();  ///< of all threads

}  // namespace stillpoint
