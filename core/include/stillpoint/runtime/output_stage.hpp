// Outputs beside thread 1: slow ones do not delay tracking.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "stillpoint/runtime/bounded_queue.hpp"
#include "stillpoint/runtime/stage.hpp"
#include "stillpoint/runtime/stop_signal.hpp"
#include "stillpoint/runtime/worker.hpp"

namespace stillpoint {

/// Outputs that get the same reports, one after the other. Threaded, reports wait in a queue.
/// Unlike those of other stages it is worked off after a stop as well: what was computed is saved.
class OutputStage {
 public:
  OutputStage(std::vector<Stage<Output>> outputs, WhenFull when_full, Mode mode, StopSignal& stop,
              TimeLog& times);
  ~OutputStage() { end(); }
  OutputStage(const OutputStage&) = delete;
  OutputStage& operator=(const OutputStage&) = delete;

  /// Before the first frame.
  void begin(const std::shared_ptr<LiveRun>& run);
  /// With a full queue it waits, or leaves out the report that has waited longest.
  void frame(FrameReportPtr report);
  /// Hands over what waits and ends the thread. No frame() may follow.
  void end();
  /// After end(): `last` (Output::finish, or what is called instead) of every output that is
  /// usable, with `summary` as it is then. The first failure stops the run.
  void finish(void (Output::*last)(const RunSummary&), const std::function<RunSummary()>& summary);
  /// Reports left out. After end().
  int dropped() const { return dropped_; }

 private:
  void write(const FrameReport& report);
  void work();

  const bool drops_;
  const std::string label_;  // of its times
  StopSignal& stop_;
  TimeLog& times_;
  std::deque<StageCaller<Output>> outputs_;
  int dropped_ = 0;  // of thread 1
  BoundedQueue<FrameReportPtr> queue_;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace stillpoint
