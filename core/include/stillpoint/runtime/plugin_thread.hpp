// Threads that plugins make themselves: stopped where they are when they would end the process.
#pragma once

#include <optional>

#include "stillpoint/engine/stage_guard.hpp"

namespace stillpoint {

/// The library that `address` lies in is a plugin's, for the rest of the process.
void remember_plugin(const void* address);

/// For the signal handlers of a StageGuard, on a thread that is in no call; `what` as in
/// reason_of(). When code of a plugin is among the callers, `may_stop` holds and somebody waits in
/// this process, the thread is stopped and this never returns; otherwise the plugin is named on
/// stderr, and after std::exit() the process ends with exit code 1. Returns when it has to end as
/// usual.
void end_plugin_thread(int what, bool may_stop);

/// Before the signal handlers are there. No thread counts as stopped.
void prepare_for_plugin_threads();

/// Of the first thread that was stopped. std::nullopt: none was.
std::optional<EndedCall> end_of_stopped_thread();

/// Waits for a thread to be stopped. There may be 64 at a time, and all are told.
class StoppedThreadWait {
 public:
  struct Slot;

  StoppedThreadWait();
  ~StoppedThreadWait();
  StoppedThreadWait(const StoppedThreadWait&) = delete;
  StoppedThreadWait& operator=(const StoppedThreadWait&) = delete;

  /// False when there are too many.
  bool possible() const { return slot_ != nullptr; }
  /// Once a thread is in wait(): until end(), threads of this process may be stopped.
  void begin();
  void end();
  /// Returns after a thread was stopped, or after end().
  void wait();

 private:
  Slot* slot_ = nullptr;
};

}  // namespace stillpoint
