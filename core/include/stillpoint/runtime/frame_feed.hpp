// Brings frames from the source to tracking.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "stillpoint/engine/pace_clock.hpp"
#include "stillpoint/runtime/bounded_queue.hpp"
#include "stillpoint/runtime/controlled_run.hpp"
#include "stillpoint/runtime/stage.hpp"
#include "stillpoint/runtime/worker.hpp"

namespace stillpoint {

/// `inline` and `pace: free`: next() asks the source. Otherwise the source has a thread of its own:
/// * `free`: it decodes up to three frames ahead (two wait, one is in its hand), and every frame is
///   used;
/// * `sensor`: it delivers frames at the rate at which they were recorded. Two may wait; when a
///   third comes, the oldest is dropped and counted. While the run is paused, it waits instead. The
///   second frame is read when the first one has been processed, with which network and memory are
///   set up. A step of more than an hour is a clock that was set: it is not waited for, and the
///   report says so.
class FrameFeed {
 public:
  FrameFeed(Stage<Source> source, const RuntimeOptions& options, PaceClock& clock,
            ControlledRun& run, StopSignal& stop, TimeLog& times);
  ~FrameFeed();

  /// Waits while the run is paused. Null at the end of the recording or after a stop. Throws
  /// StageError when the source failed, after the frames that came before.
  FramePtr next();
  /// Ends the thread. Only after a stop or when next() gave null.
  void end();

  /// By the source so far. On any thread.
  std::size_t left_out() const { return left_out_; }

  /// Only after end().
  SourceReport report();
  std::size_t dropped() const { return dropped_; }

 private:
  FramePtr read();
  void work();
  void deliver(FramePtr frame);
  void wait_for_first_frame();
  void say_that_first_frame_is_processed();

  const RuntimeOptions::Pace pace_;
  const bool thorough_;
  PaceClock& clock_;
  ControlledRun& run_;
  StopSignal& stop_;
  TimeLog& times_;
  StageCaller<Source> source_;
  std::uint32_t frames_read_ = 0;
  FramePtr previous_;  // the last one read
  std::atomic<std::size_t> left_out_ = 0;
  std::size_t dropped_ = 0;
  std::optional<double> clock_ahead_;  // seconds from the recording's time to that of the clock
  std::optional<double> last_time_;    // seconds, of the recording, delivered
  int clock_steps_ = 0;                // too long to be waited for
  bool first_taken_ = false;           // by the thread that calls next()
  std::mutex mutex_;
  std::condition_variable_any first_processed_;
  bool is_first_processed_ = false;  // guarded by mutex_
  std::exception_ptr failure_;       // written before the queue is closed, read after
  BoundedQueue<FramePtr> queue_;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace stillpoint
