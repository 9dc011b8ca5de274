// Beside thread 1: stages that do not need tracking run while it extracts features (paper, Fig. 2).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "stillpoint/runtime/time_log.hpp"
#include "stillpoint/runtime/worker.hpp"

namespace stillpoint {

/// What a stage beside tracking gives; there once BesideTracking::wait() has returned true.
template <class Result>
class FutureResult {
 public:
  const Result& operator*() const { return **result_; }
  const Result* operator->() const { return &**result_; }

 private:
  friend class BesideTracking;
  std::shared_ptr<std::optional<Result>> result_ = std::make_shared<std::optional<Result>>();
};

/// Calls stages one after the other, in the order in which they were started: a later one may use
/// what an earlier one gave. `threaded`: on a thread of its own; an exception stops the whole run.
/// `inline`: in wait(), whose caller gets the exception.
class BesideTracking {
 public:
  BesideTracking(Mode mode, StopSignal& stop, TimeLog& times)
      : times_(times), thread_(mode, kCallsWaiting, stop, [](const Call& call) { call(); }) {}

  /// `call` has to own or outlive what it uses: wait() may never be reached.
  template <class Function>
  auto start(Function call) -> FutureResult<std::invoke_result_t<Function&>> {
    FutureResult<std::invoke_result_t<Function&>> later;
    add([call = std::move(call), result = later.result_] { result->emplace(call()); });
    return later;
  }

  /// Waits for all that was started; the time counts for `frame`. False after a stop.
  bool wait(std::uint32_t frame) {
    if (!thread_.threaded()) {
      for (const Call& call : std::exchange(started_, {})) call();
      return true;
    }
    const ScopedTime time(times_, "beside_wait", frame);
    return thread_.wait_idle();
  }

  /// Ends the thread.
  void end() { thread_.end(); }

 private:
  using Call = std::function<void()>;
  static constexpr std::size_t kCallsWaiting = 4;  // more than one frame has

  void add(Call call) {
    if (thread_.threaded())
      thread_.push(std::move(call));
    else
      started_.push_back(std::move(call));
  }

  TimeLog& times_;
  std::vector<Call> started_;  // inline, until wait()
  Worker<Call> thread_;        // last: it uses all the others
};

}  // namespace stillpoint
