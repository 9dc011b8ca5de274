#include "stillpoint/runtime/plugin_thread.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>
#include <sched.h>
#include <semaphore.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <span>

#include "stillpoint/runtime/abnormal_end.hpp"

namespace stillpoint {

struct StoppedThreadWait::Slot {
  Slot() { ::sem_init(&thread_was_stopped, 0, 0); }

  std::atomic_flag taken;
  std::atomic<pid_t> process{0};  // 0: a stopped thread is none of its business
  sem_t thread_was_stopped{};
};

namespace {

/// Where the libraries of plugins begin in memory: an array, since signal handlers read it.
std::array<std::atomic<const void*>, 256> libraries{};

/// The first one, outside all calls. It stays where it is.
struct StoppedThread {
  std::atomic_flag taken;
  std::atomic<int> what{0};  // as in reason_of(), set when the library is; 0: none
  std::array<char, 1024> library{};
};
StoppedThread stopped_thread;

std::array<StoppedThreadWait::Slot, 64> slots;  // an array, since signal handlers read it

bool somebody_waits() {
  return std::ranges::any_of(slots, [](const auto& slot) { return slot.process == ::getpid(); });
}

const void* begin_of_object(const void* address) {
  dl_find_object object{};
  return ::_dl_find_object(const_cast<void*>(address), &object) == 0 ? object.dlfo_map_start
                                                                     : nullptr;
}

/// The file of the plugin whose code is among the callers; nullptr: no plugin's. For signal
/// handlers: prepare_for_plugin_threads() has loaded what backtrace() needs.
const char* plugin_among_callers() {
  std::array<void*, 64> callers{};
  const int depth = ::backtrace(callers.data(), static_cast<int>(callers.size()));
  for (void* caller : std::span(callers).first(static_cast<std::size_t>(depth))) {
    dl_find_object object{};
    if (::_dl_find_object(caller, &object) != 0) continue;
    for (const auto& library : libraries)
      if (library == object.dlfo_map_start) return object.dlfo_link_map->l_name;
  }
  return nullptr;
}

/// Never returns: the thread may hold locks, and ending it would run more of the plugin's code.
[[noreturn]] void stop_thread(const char* library, int what) {
  if (!stopped_thread.taken.test_and_set()) {
    std::strncpy(stopped_thread.library.data(), library, stopped_thread.library.size() - 1);
    stopped_thread.what = what;
    start_time_to_save(std::array{"a thread of ", library, " failed"});
  }
  while (stopped_thread.what == 0) ::sched_yield();  // another thread is just writing it
  for (StoppedThreadWait::Slot& slot : slots)
    if (slot.process == ::getpid()) ::sem_post(&slot.thread_was_stopped);
  for (;;) ::pause();
}

}  // namespace

void remember_plugin(const void* address) {
  const void* const begin = begin_of_object(address);
  for (auto& library : libraries) {
    const void* none = nullptr;
    if (library.compare_exchange_strong(none, begin) || none == begin) break;
  }
}

void end_plugin_thread(int what, bool may_stop) {
  const char* const library = plugin_among_callers();
  if (!library) return;
  if (may_stop && somebody_waits()) stop_thread(library, what);
  write_to_stderr("error: ended by ");
  write_to_stderr(library);
  write_to_stderr("\n");
  if (what == kExited) ::_exit(1);
}

std::optional<EndedCall> end_of_stopped_thread() {
  if (stopped_thread.what == 0) return std::nullopt;
  return EndedCall(reason_of(stopped_thread.what),
                   std::string("a thread of ") + stopped_thread.library.data());
}

void prepare_for_plugin_threads() {
  std::array<void*, 1> caller{};
  ::backtrace(caller.data(), 1);  // loads what later calls need, which a signal handler must not
  stopped_thread.taken.clear();
  stopped_thread.what = 0;
  stopped_thread.library.fill('\0');
}

StoppedThreadWait::StoppedThreadWait() {
  const auto free =
      std::ranges::find_if(slots, [](Slot& slot) { return !slot.taken.test_and_set(); });
  if (free == slots.end()) return;
  slot_ = &*free;
  while (::sem_trywait(&slot_->thread_was_stopped) == 0) {  // what was left for an earlier one
  }
}

StoppedThreadWait::~StoppedThreadWait() {
  if (slot_) slot_->taken.clear();
}

void StoppedThreadWait::begin() { slot_->process = ::getpid(); }

void StoppedThreadWait::end() {
  slot_->process = 0;
  ::sem_post(&slot_->thread_was_stopped);
}

void StoppedThreadWait::wait() {
  while (::sem_wait(&slot_->thread_was_stopped) != 0) {
  }
}

}  // namespace stillpoint
