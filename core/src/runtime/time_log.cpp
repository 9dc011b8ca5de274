#include "stillpoint/runtime/time_log.hpp"

#include <ctime>
#include <utility>

namespace stillpoint {
namespace {

double read_clock(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

void TimeLog::add(StageTime time) {
  const std::lock_guard lock(mutex_);
  times_.push_back(std::move(time));
}

std::vector<StageTime> TimeLog::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(times_, {});
}

ScopedTime::ScopedTime(TimeLog& log, const char* stage, std::uint32_t frame)
    : log_(log),
      stage_(stage),
      frame_(frame),
      wall_start_(std::chrono::steady_clock::now()),
      cpu_start_(thread_cpu_seconds()) {}

ScopedTime::~ScopedTime() {
  if (discarded_) return;
  const std::chrono::duration<double, std::milli> wall =
      std::chrono::steady_clock::now() - wall_start_;
  log_.add({stage_, wall.count(), 1e3 * (thread_cpu_seconds() - cpu_start_), frame_});
}

double thread_cpu_seconds() { return read_clock(CLOCK_THREAD_CPUTIME_ID); }

double process_cpu_seconds() { return read_clock(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace stillpoint
