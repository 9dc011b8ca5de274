#include "stillpoint/engine/stage_guard.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <pthread.h>
#include <semaphore.h>
#include <setjmp.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iomanip>
#include <memory>
#include <mutex>
#include <span>
#include <sstream>
#include <stdexcept>

#include "stillpoint/engine/stage_error.hpp"
#include "stillpoint/runtime/read_only_images.hpp"

namespace stillpoint {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array kCrashes = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr int kGiveUp = SIGUSR2;
constexpr int kExited = 1000;  // beyond all signals, like the next
constexpr int kWroteToImage = 1001;
constexpr unsigned kSecondsToSave = 30;
constexpr std::size_t kHandlerStackSize = 64 * 1024;  // bytes
// A call may wait for a thread that has crashed. Others shall come to their end before that: what
// is ended leaves its locks behind.
constexpr std::chrono::seconds kTimeToReturn{2};

struct Call {
  const std::string& stage;
  std::optional<std::uint32_t> frame;
  Clock::time_point start = Clock::now();
  pthread_t thread = pthread_self();
  bool reported = false;         // that it is late
  Call* outer = nullptr;         // of the same thread
  sigjmp_buf return_point = {};  // back to call_guarded()
};

// Of a thread; read by signal handlers, hence no lazy allocation.
#define STILLPOINT_OF_THREAD thread_local __attribute__((tls_model("initial-exec")))
STILLPOINT_OF_THREAD Call* current = nullptr;
STILLPOINT_OF_THREAD volatile sig_atomic_t bookkeeping = 0;

std::atomic<bool> guarded{false};
std::atomic<bool> ended_a_call{false};

/// Where the libraries of plugins begin in memory: signal handlers look for them, hence no list.
std::array<std::atomic<const void*>, 256> libraries{};

/// The first thread of a plugin that ended outside all calls. Such a thread stays where it is.
struct EndedThread {
  std::atomic<int> what{0};  // as in reason_of(); 0: none. The rest is set before
  std::array<char, 1024> library{};
  std::atomic<bool> told{false};  // a call has failed for it
  sem_t happened{};
};
EndedThread ended_thread;
pid_t watched_process = 0;              // that of watch_threads()
std::array<char, 256> final_message{};  // of the handler of SIGALRM
std::mutex calls_mutex;
std::vector<Call*> calls;  // guarded by calls_mutex

/// In `calls`, and `current`, while it lives.
class Registered {
 public:
  explicit Registered(Call& call) {
    bookkeeping = 1;
    call.outer = current;
    {
      const std::lock_guard lock(calls_mutex);
      calls.push_back(&call);
    }
    current = &call;
    bookkeeping = 0;
  }
  ~Registered() {
    bookkeeping = 1;
    Call* const call = current;
    current = call->outer;
    {
      const std::lock_guard lock(calls_mutex);
      std::erase(calls, call);
    }
    bookkeeping = 0;
  }
  Registered(const Registered&) = delete;
  Registered& operator=(const Registered&) = delete;
};

/// An alternate stack: after a stack overflow, signal handlers cannot use the thread's own.
class HandlerStack {
 public:
  HandlerStack() : memory_(std::make_unique<char[]>(kHandlerStackSize)) {
    stack_t stack{};
    stack.ss_sp = memory_.get();
    stack.ss_size = kHandlerStackSize;
    sigaltstack(&stack, nullptr);
  }
  ~HandlerStack() {
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    sigaltstack(&none, nullptr);
  }
  HandlerStack(const HandlerStack&) = delete;
  HandlerStack& operator=(const HandlerStack&) = delete;

 private:
  std::unique_ptr<char[]> memory_;
};

/// The file of the plugin whose code the calling thread is in; nullptr: no plugin's. For signal
/// handlers: the caller has loaded what backtrace() needs.
const char* plugin_of_thread() {
  std::array<void*, 64> callers{};
  const int depth = ::backtrace(callers.data(), static_cast<int>(callers.size()));
  for (void* caller : std::span(callers).first(static_cast<std::size_t>(depth))) {
    Dl_info object{};
    if (::dladdr(caller, &object) == 0) continue;
    for (const auto& library : libraries)
      if (library == object.dli_fbase) return object.dli_fname;
  }
  return nullptr;
}

/// Returns when it is no thread of a plugin, or in a child of the guarded process, where nobody
/// watches: that one ends as usual. It must not go on, and must not end: it may hold
/// locks, and exit() or the end of a thread would run more code of the plugin.
void keep_thread_of_plugin(int what) {
  static std::atomic_flag taken;
  const char* const library = ::getpid() == watched_process ? plugin_of_thread() : nullptr;
  if (!library) return;
  ended_a_call = true;
  if (!taken.test_and_set()) {
    std::strncpy(ended_thread.library.data(), library, ended_thread.library.size() - 1);
    ended_thread.what = what;
    ::sem_post(&ended_thread.happened);
  }
  for (;;) ::pause();
}

void write_to_stderr(const char* words) {  // for signal handlers
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words, std::strlen(words));
}

extern "C" void on_crash(int signal, siginfo_t* info, void*) {
  const bool wrote_to_image = signal == SIGSEGV && in_read_only_image(info->si_addr);
  const int what = wrote_to_image ? kWroteToImage : signal;
  if (current && !bookkeeping) siglongjmp(current->return_point, what);
  if (!current) keep_thread_of_plugin(what);
  if (wrote_to_image) write_to_stderr("error: a thread of a plugin wrote to an image of a frame\n");
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

extern "C" void on_give_up(int signal) {
  if (current && !bookkeeping) siglongjmp(current->return_point, signal);
}

extern "C" void on_exit_of_process() {
  if (guarded && current && !bookkeeping) siglongjmp(current->return_point, kExited);
  if (guarded && !current) keep_thread_of_plugin(kExited);
}

extern "C" void on_saving_hangs(int) {
  write_to_stderr(final_message.data());
  ::_exit(1);
}

std::string reason_of(int what) {
  if (what == kExited) return "it called std::exit()";
  if (what == kWroteToImage)
    return "it wrote to an image of a frame, which all stages share; work on a copy of it";
  if (what == kGiveUp) return "it did not return and was given up";
  return std::string("it crashed: SIG") + sigabbrev_np(what) + ", " + sigdescr_np(what);
}

/// What follows has a time to save results in.
void begin_to_save(const std::string& where, const std::string& reason) {
  std::snprintf(final_message.data(), final_message.size(),
                "error: %s: %s; what followed did not return, results may be missing\n",
                where.c_str(), reason.c_str());
  ::alarm(kSecondsToSave);
}

std::string name_of_ended_thread() {
  return std::string("a thread of ") + ended_thread.library.data();
}

/// "a thread of PLUGIN failed: it crashed: …"
[[noreturn]] void throw_of_ended_thread() {
  ended_thread.told = true;
  const std::runtime_error reason(reason_of(ended_thread.what));
  throw StageError(name_of_ended_thread(), std::nullopt, &reason);
}

/// For the first call that notices.
void throw_of_ended_thread_once() {
  if (ended_thread.what != 0 && !ended_thread.told.exchange(true)) throw_of_ended_thread();
}

[[noreturn]] void fail(const Call& call, int what) {
  if (what == kGiveUp && ended_thread.what != 0) throw_of_ended_thread();  // it waited for that one
  const std::string reason = reason_of(what);
  begin_to_save(call.stage, reason);
  ended_a_call = true;
  throw std::runtime_error(reason);
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string text_of(const Call& call) {
  std::ostringstream text;
  text << call.stage << " has not returned for " << std::setprecision(2)
       << seconds_since(call.start) << " s";
  if (call.frame) text << ", frame " << *call.frame;
  return text.str();
}

void watch(const std::stop_token& stop, double patience, const LateCalls::Late& late) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  const auto pause = std::chrono::duration<double>(std::min(patience / 4, 1.0));
  while (!stopped.wait_for(lock, stop, pause, [] { return false; }) && !stop.stop_requested()) {
    std::vector<std::string> texts;
    {
      const std::lock_guard all(calls_mutex);
      for (Call* call : calls)
        if (!call->reported && seconds_since(call->start) > patience) {
          call->reported = true;
          texts.push_back(text_of(*call));
        }
    }
    for (const std::string& text : texts) late(text);
  }
}

std::size_t give_up_calls_since_before(Clock::time_point time) {
  const std::lock_guard all(calls_mutex);
  return static_cast<std::size_t>(std::ranges::count_if(calls, [&](const Call* call) {
    return call->start < time && pthread_kill(call->thread, kGiveUp) == 0;
  }));
}

/// Sees to it that the run ends after a thread of a plugin has ended.
void watch_threads(const std::stop_token& stop) {
  while (::sem_wait(&ended_thread.happened) != 0) {
  }
  if (stop.stop_requested()) return;
  const auto end_of_thread = Clock::now();
  begin_to_save(name_of_ended_thread(), reason_of(ended_thread.what));
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  stopped.wait_for(lock, stop, kTimeToReturn, [] { return false; });
  if (!stop.stop_requested()) give_up_calls_since_before(end_of_thread);
}

void handle_crash(int signal) {
  struct sigaction action {};
  action.sa_sigaction = on_crash;
  action.sa_flags = SA_ONSTACK | SA_SIGINFO;
  sigaction(signal, &action, nullptr);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_ONSTACK;
  sigaction(signal, &action, nullptr);
}

}  // namespace

StageGuard::StageGuard() {
  std::array<void*, 1> caller{};
  ::backtrace(caller.data(), 1);  // loads what later calls need, which a signal handler must not
  ::sem_init(&ended_thread.happened, 0, 0);
  watched_process = ::getpid();
  threads_ = std::jthread(watch_threads);
  for (const int signal : kCrashes) handle_crash(signal);
  handle(kGiveUp, on_give_up);
  handle(SIGALRM, on_saving_hangs);
  std::atexit(on_exit_of_process);
  ended_a_call = false;
  guarded = true;
}

StageGuard::~StageGuard() {
  guarded = false;
  threads_.request_stop();
  ::sem_post(&ended_thread.happened);
  ::alarm(0);
  for (const int signal : kCrashes) ::signal(signal, SIG_DFL);
  ::signal(kGiveUp, SIG_IGN);
  ::signal(SIGALRM, SIG_DFL);
}

void StageGuard::library_was_loaded(const void* begin) {
  for (auto& library : libraries) {
    const void* none = nullptr;
    if (library.compare_exchange_strong(none, begin) || none == begin) break;
  }
  if (guarded) std::atexit(on_exit_of_process);
}

std::vector<std::string> StageGuard::calls_longer_than(double seconds) {
  std::vector<std::string> texts;
  const std::lock_guard all(calls_mutex);
  for (const Call* call : calls)
    if (seconds_since(call->start) > seconds) texts.push_back(text_of(*call));
  return texts;
}

std::size_t StageGuard::give_up() { return give_up_calls_since_before(Clock::time_point::max()); }

bool StageGuard::is_in_call() { return current != nullptr; }

bool StageGuard::has_ended_a_call() { return ended_a_call; }

std::string StageGuard::unreported_end() {
  try {
    throw_of_ended_thread_once();
  } catch (const StageError& error) {
    return error.what();
  }
  return {};
}

LateCalls::LateCalls(double patience_seconds, Late late) {
  if (patience_seconds > 0)
    watcher_ =
        std::jthread([patience_seconds, late = std::move(late)](const std::stop_token& stop) {
          watch(stop, patience_seconds, late);
        });
}

void call_guarded(const std::string& stage, std::optional<std::uint32_t> frame,
                  void (*function)(void*), void* argument) {
  if (!guarded) return function(argument);
  if (!current) throw_of_ended_thread_once();
  thread_local const HandlerStack kStack;
  Call call{.stage = stage, .frame = frame};
  const Registered registered(call);
  const int what = sigsetjmp(call.return_point, 1);
  if (what != 0) fail(call, what);
  function(argument);
}

}  // namespace stillpoint
