// Threads of plugins that crash or end the process: the run ends, and what was computed is saved.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "stillpoint/export.hpp"

namespace stillpoint {

class StoppedThreadWait;

/// While it lives, and a StageGuard, a thread that ends the process by a crash, an exception or
/// std::exit() ends the run instead, if code of a plugin is among its callers: the plugin has made
/// it, or a pool for it. It is stopped where it is, for the rest of the process. Not recognised are
/// a stack that overflows there, and threads of a library that run none of the plugin's own code.
/// Of several watches all are told, 64 at most; a child of the process (fork) is not watched.
class STILLPOINT_EXPORT ThreadWatch {
 public:
  /// Called on the watch's thread, once, with a StageError: "a thread of PLUGIN failed: it crashed:
  /// …". Calls of stages that have not returned two seconds after that are ended, and later ones
  /// that take more than ten: they may wait for the thread.
  using Ended = std::function<void(std::exception_ptr failure)>;
  explicit ThreadWatch(Ended ended);
  ~ThreadWatch();
  ThreadWatch(const ThreadWatch&) = delete;
  ThreadWatch& operator=(const ThreadWatch&) = delete;

  /// "a thread of PLUGIN failed: it crashed: …"; empty: none was stopped since the StageGuard
  /// began.
  static std::string failure_text();

 private:
  std::unique_ptr<StoppedThreadWait> wait_;
  std::jthread watcher_;  // last: it uses the other
};

}  // namespace stillpoint
