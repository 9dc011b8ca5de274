#include "stillpoint/runtime/frame_feed.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>

#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/runtime/perception_results.hpp"
#include "stillpoint/runtime/read_only_images.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint {
namespace {

constexpr std::size_t kFramesAhead = 2;
// A longer step of the recording's time is no pause of it: a clock was set. Seconds.
constexpr double kLongestWait = 3600.0;

std::optional<Frame> next_of(Source& source, std::uint32_t index, const Frame* previous,
                             bool thorough) {
  std::optional<Frame> frame = source.next();
  if (!frame) return frame;
  check_frame(*frame, index, previous);
  if (!thorough) return frame;
  check_thoroughly(*frame);
  return with_read_only_images(std::move(*frame));
}

}  // namespace

double SteadyClock::now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void SteadyClock::wait_until(double time, std::stop_token stop) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end(
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time)));
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  stopped.wait_until(lock, std::move(stop), end, [] { return false; });
}

FrameFeed::FrameFeed(Stage<Source> source, const RuntimeOptions& options, PaceClock& clock,
                     ControlledRun& run, StopSignal& stop, TimeLog& times)
    : pace_(options.pace),
      thorough_(options.validates_fully()),
      clock_(clock),
      run_(run),
      stop_(stop),
      times_(times),
      source_(std::move(source), "source", times),
      queue_(kFramesAhead) {
  source_.call_unmeasured({}, &Source::begin, stop_.token());
  if (options.mode == Mode::kThreaded || pace_ == RuntimeOptions::Pace::kSensor)
    thread_ = std::jthread([this] { work(); });
}

FrameFeed::~FrameFeed() {
  queue_.close();
  say_that_first_frame_is_processed();
  end();
}

void FrameFeed::end() {
  if (thread_.joinable()) thread_.join();
  // A stop may have come before next() could throw it. What else fails then is the stop's doing.
  if (failure_ && StageGuard::has_ended_a_call()) stop_.fail(failure_);
}

SourceReport FrameFeed::report() {
  if (!source_.usable()) return {};
  SourceReport report = source_.call_unmeasured({}, &Source::report);
  if (clock_steps_ > 0)
    report.warnings.push_back("the recording's time goes on by more than an hour, " +
                              std::to_string(clock_steps_) +
                              (clock_steps_ == 1 ? " time" : " times") +
                              ": a clock was set, and `pace: sensor` did not wait for it");
  return report;
}

FramePtr FrameFeed::next() {
  if (std::exchange(first_taken_, true)) say_that_first_frame_is_processed();
  FramePtr frame;
  if (!thread_.joinable()) {
    if (!stop_.requested()) frame = read();
  } else if (auto popped = queue_.pop(stop_.token())) {
    frame = *std::move(popped);
  } else if (!stop_.requested() && failure_) {
    std::rethrow_exception(failure_);
  }
  if (frame) run_.wait_while_paused(stop_.token());  // at the end there is nothing to wait for
  return stop_.requested() ? nullptr : frame;
}

FramePtr FrameFeed::read() {
  ScopedTime time(times_, "source", frames_read_);
  std::optional<Frame> frame =
      source_.call_unmeasured(frames_read_, next_of, frames_read_, previous_.get(), thorough_);
  left_out_ = source_.call_unmeasured(frames_read_, &Source::left_out);
  if (!frame) {
    time.discard();  // the end is no frame
    return nullptr;
  }
  ++frames_read_;
  return previous_ = std::make_shared<const Frame>(std::move(*frame));
}

void FrameFeed::work() {
  try {
    while (FramePtr frame = stop_.requested() ? nullptr : read()) {
      deliver(std::move(frame));
      if (pace_ == RuntimeOptions::Pace::kSensor && frames_read_ == 1) wait_for_first_frame();
    }
  } catch (...) {
    failure_ = std::current_exception();
  }
  queue_.close();
}

void FrameFeed::deliver(FramePtr frame) {
  if (pace_ == RuntimeOptions::Pace::kFree) {
    queue_.push(std::move(frame), stop_.token());
    return;
  }
  const double time = frame->time;
  if (last_time_ && time - *last_time_ > kLongestWait) {
    clock_ahead_.reset();  // due at once
    ++clock_steps_;
  }
  last_time_ = time;
  if (clock_ahead_) clock_.wait_until(time + *clock_ahead_, stop_.token());
  const bool paused = run_.paused();
  if (clock_ahead_ && !paused) {
    if (queue_.push_or_drop_oldest(std::move(frame))) ++dropped_;
    return;
  }
  clock_ahead_.reset();  // after a pause, the next frame is due at once, as the first one was
  if (!paused) clock_ahead_ = clock_.now() - time;
  queue_.push(std::move(frame), stop_.token());
}

// Before the second one is read: of a camera, it would be old by then.
void FrameFeed::wait_for_first_frame() {
  std::unique_lock lock(mutex_);
  first_processed_.wait(lock, stop_.token(), [this] { return is_first_processed_; });
  clock_ahead_.reset();  // the second one is due at once
}

void FrameFeed::say_that_first_frame_is_processed() {
  const std::lock_guard lock(mutex_);
  is_first_processed_ = true;
  first_processed_.notify_all();
}

}  // namespace stillpoint
