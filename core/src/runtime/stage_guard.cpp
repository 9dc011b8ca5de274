#include "stillpoint/engine/stage_guard.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>
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
// After the end of a thread: calls that were under way may wait for it, and so may those that save
// results. What is ended leaves its locks behind, hence some patience.
constexpr std::chrono::seconds kTimeToReturn{2};
constexpr std::chrono::seconds kTimeToSave{10};

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
STILLPOINT_OF_THREAD bool calls_stages = false;  // a thread of the engine or of its user

std::atomic<bool> guarded{false};
std::atomic<bool> ended_a_call{false};

/// Where the libraries of plugins begin in memory: an array, since signal handlers read it.
std::array<std::atomic<const void*>, 256> libraries{};

/// The first thread of a plugin that ended outside all calls. It stays where it is.
struct EndedThread {
  std::atomic_flag taken;
  std::atomic<int> what{0};  // as in reason_of(), set last; 0: none
  std::array<char, 1024> library{};
};
EndedThread ended_thread;
sem_t thread_ended{};
std::atomic<pid_t> watched_process{0};   // that of the ThreadWatch; 0: there is none
std::array<char, 1280> final_message{};  // of the handler of SIGALRM
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

const void* begin_of_object(const void* address) {
  dl_find_object object{};
  return ::_dl_find_object(const_cast<void*>(address), &object) == 0 ? object.dlfo_map_start
                                                                     : nullptr;
}

/// The file of the plugin whose code is among the callers; nullptr: no plugin's. For signal
/// handlers: StageGuard has loaded what backtrace() needs.
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

void write_to_stderr(const char* words) {  // for signal handlers
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words, std::strlen(words));
}

/// Cuts off what finds no room. For signal handlers.
void append(std::span<char> text, const char* words) {
  const std::size_t used = std::strlen(text.data());
  std::strncpy(text.data() + used, words, text.size() - used - 1);
}

/// Never returns: the thread may hold locks, and ending it would run more of the plugin's code.
[[noreturn]] void stop_thread(const char* library, int what) {
  if (!ended_thread.taken.test_and_set()) {
    append(ended_thread.library, library);
    append(final_message, "error: a thread of ");
    append(final_message, library);
    append(final_message, " failed; what followed did not return, results may be missing\n");
    ::alarm(kSecondsToSave);
    ended_thread.what = what;
    ended_a_call = true;
    ::sem_post(&thread_ended);
  }
  for (;;) ::pause();
}

/// Of a thread that is in no call. Returns when the process has to end as usual.
void end_thread(int what) {
  const char* const library = plugin_among_callers();
  if (!library) return;
  if (!calls_stages && ::getpid() == watched_process) stop_thread(library, what);
  write_to_stderr("error: ended by ");
  write_to_stderr(library);
  write_to_stderr("\n");
  if (what == kExited) ::_exit(1);
}

extern "C" void on_crash(int signal, siginfo_t* info, void*) {
  const bool wrote_to_image = signal == SIGSEGV && in_read_only_image(info->si_addr);
  const int what = wrote_to_image ? kWroteToImage : signal;
  if (current && !bookkeeping) siglongjmp(current->return_point, what);
  if (!current) end_thread(what);
  if (wrote_to_image) write_to_stderr("error: a thread of a plugin wrote to an image of a frame\n");
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

extern "C" void on_give_up(int signal) {
  if (current && !bookkeeping) siglongjmp(current->return_point, signal);
}

extern "C" void on_exit_of_process() {
  if (guarded && current && !bookkeeping) siglongjmp(current->return_point, kExited);
  if (guarded && !current) end_thread(kExited);
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

StageError error_of_ended_thread() {
  const std::runtime_error reason(reason_of(ended_thread.what));
  return {std::string("a thread of ") + ended_thread.library.data(), std::nullopt, &reason};
}

[[noreturn]] void fail(const Call& call, int what) {
  if (what == kGiveUp && ended_thread.what != 0) throw error_of_ended_thread();  // waited for it
  const std::string reason = reason_of(what);
  std::snprintf(final_message.data(), final_message.size(),
                "error: %s: %s; what followed did not return, results may be missing\n",
                call.stage.c_str(), reason.c_str());
  ::alarm(kSecondsToSave);
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

std::size_t give_up_calls_begun_before(Clock::time_point time) {
  const std::lock_guard all(calls_mutex);
  return static_cast<std::size_t>(std::ranges::count_if(calls, [&](const Call* call) {
    return call->start < time && pthread_kill(call->thread, kGiveUp) == 0;
  }));
}

void watch_threads(const std::stop_token& stop, const ThreadWatch::Ended& ended) {
  while (::sem_wait(&thread_ended) != 0) {
  }
  if (stop.stop_requested()) return;
  const auto end_of_thread = Clock::now();
  ended(std::make_exception_ptr(error_of_ended_thread()));
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  const auto wait = [&](std::chrono::seconds time) {
    stopped.wait_for(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
  };
  if (wait(kTimeToReturn)) give_up_calls_begun_before(end_of_thread);
  while (wait(kTimeToSave)) give_up_calls_begun_before(Clock::now() - kTimeToSave);
}

/// Signals are for threads that wait for them.
std::jthread without_signals(std::function<void(const std::stop_token&)> function) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::jthread thread(std::move(function));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
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
  ended_thread.taken.clear();
  ended_thread.what = 0;
  ended_thread.library.fill('\0');
  final_message.fill('\0');
  for (const int signal : kCrashes) handle_crash(signal);
  handle(kGiveUp, on_give_up);
  handle(SIGALRM, on_saving_hangs);
  std::atexit(on_exit_of_process);
  ended_a_call = false;
  guarded = true;
}

StageGuard::~StageGuard() {
  guarded = false;
  ::alarm(0);
  for (const int signal : kCrashes) ::signal(signal, SIG_DFL);
  ::signal(kGiveUp, SIG_IGN);
  ::signal(SIGALRM, SIG_DFL);
}

void StageGuard::library_was_loaded(const void* address) {
  const void* const begin = begin_of_object(address);
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

std::size_t StageGuard::give_up() { return give_up_calls_begun_before(Clock::time_point::max()); }

bool StageGuard::is_in_call() { return current != nullptr; }

bool StageGuard::has_ended_a_call() { return ended_a_call; }

std::string StageGuard::ended_thread_text() {
  return ended_thread.what != 0 ? error_of_ended_thread().what() : std::string();
}

ThreadWatch::ThreadWatch(Ended ended) {
  if (!guarded) return;
  ::sem_init(&thread_ended, 0, 0);
  watcher_ = without_signals(
      [ended = std::move(ended)](const std::stop_token& stop) { watch_threads(stop, ended); });
  watched_process = ::getpid();
}

ThreadWatch::~ThreadWatch() {
  if (!watcher_.joinable()) return;
  watched_process = 0;
  watcher_.request_stop();
  ::sem_post(&thread_ended);
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
  calls_stages = true;
  thread_local const HandlerStack kStack;
  Call call{.stage = stage, .frame = frame};
  const Registered registered(call);
  const int what = sigsetjmp(call.return_point, 1);
  if (what != 0) fail(call, what);
  function(argument);
}

}  // namespace stillpoint
