// Plugins that crash, end the process or never return: named, and what was computed is saved.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// While a guard exists, a plugin that raises SIGSEGV, SIGBUS, SIGFPE, SIGILL or SIGABRT, or calls
/// std::exit(), fails as if it had thrown an exception: in a stage, in a constructor, or while it
/// is loaded. Only for programs that own their signal handlers; one guard at a time.
///
/// Threads that a plugin has made itself are for ThreadWatch.
///
/// Locks and memory that the plugin held are not released: results can be saved, but the run cannot
/// go on. In case saving hangs as well, the process is ended after half a minute: a program that
/// goes on destroys the guard once it has saved.
class STILLPOINT_EXPORT StageGuard {
 public:
  StageGuard();
  ~StageGuard();
  StageGuard(const StageGuard&) = delete;
  StageGuard& operator=(const StageGuard&) = delete;

  /// To be called after each library is loaded: std::exit() destroys in reverse order, so that the
  /// statics of a library loaded after the guard would go before the guard notices the exit.
  /// `address`: of anything in the library, by which its threads are recognised.
  static void library_was_loaded(const void* address);
  /// The calls of plugins that take longer than that: "tracking (orb) has not returned for 12 s,
  /// frame 3".
  static std::vector<std::string> calls_longer_than(double seconds);
  using Time = std::chrono::steady_clock::time_point;
  /// Ends the calls under way that were begun before that, where they are: they fail. Gives their
  /// number.
  static std::size_t give_up(Time begun_before = Time::max());
  /// Whether this thread is in a guarded call.
  static bool is_in_call();
  /// Whether it had to end a call, or to stop a thread. Destructors of that plugin may crash or
  /// hang as well.
  static bool has_ended_a_call();
  /// Whether there is a guard in this process.
  static bool exists();
};

/// While it lives, says which calls of plugins take long; one at a time.
class STILLPOINT_EXPORT LateCalls {
 public:
  /// Called on a thread of its own, once for each call that takes longer than `patience_seconds`;
  /// 0: never.
  using Late = std::function<void(const std::string& what)>;
  LateCalls(double patience_seconds, Late late);

 private:
  std::jthread watcher_;
};

/// That a guard had to end a call, and why. The object that was called is in an unknown state, and
/// its locks may be held: it must not be called again.
class STILLPOINT_EXPORT EndedCall final : public std::runtime_error {
 public:
  /// `thread`: "a thread of FILE", if that was stopped and the call waited for it.
  explicit EndedCall(const std::string& reason, std::string thread = {});
  const std::string& thread() const { return thread_; }

 private:
  std::string thread_;
};

/// Calls `function(argument)`, which is the plugin's. Throws EndedCall when a guard had to end it.
STILLPOINT_EXPORT void call_guarded(const std::string& stage, std::optional<std::uint32_t> frame,
                                    void (*function)(void*), void* argument);

/// The same for anything that can be called; gives what it gives.
template <class Function>
auto call_guarded(const std::string& stage, std::optional<std::uint32_t> frame, Function& function)
    -> decltype(function()) {
  using Result = decltype(function());
  if constexpr (std::is_void_v<Result>) {
    call_guarded(
        stage, frame, [](void* f) { (*static_cast<Function*>(f))(); }, &function);
  } else {
    std::optional<Result> result;
    auto keep = [&] { result.emplace(function()); };
    call_guarded(stage, frame, keep);
    return std::move(*result);
  }
}

}  // namespace stillpoint
