#include "stillpoint/runtime/plugin_thread.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>
#include <semaphore.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <span>

#include "stillpoint/runtime/abnormal_end.hpp"

namespace stillpoint {
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
sem_t thread_was_stopped{};
std::atomic<pid_t> waiting_process{0};  // 0: nobody waits

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
    ::sem_post(&thread_was_stopped);
  }
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
  if (may_stop && ::getpid() == waiting_process) stop_thread(library, what);
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

void prepare_wait_for_threads() { ::sem_init(&thread_was_stopped, 0, 0); }

void begin_wait_for_threads() { waiting_process = ::getpid(); }

void end_wait_for_threads() {
  waiting_process = 0;
  ::sem_post(&thread_was_stopped);
}

void wait_for_stopped_thread() {
  while (::sem_wait(&thread_was_stopped) != 0) {
  }
}

}  // namespace stillpoint
