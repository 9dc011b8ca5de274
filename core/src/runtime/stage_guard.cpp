#include "stillpoint/engine/stage_guard.hpp"

#include <pthread.h>
#include <setjmp.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <iomanip>
#include <memory>
#include <mutex>
#include <sstream>
#include <utility>

#include "../image_codec/codec_loading.hpp"
#include "stillpoint/runtime/abnormal_end.hpp"
#include "stillpoint/runtime/plugin_thread.hpp"
#include "stillpoint/runtime/read_only_images.hpp"

namespace stillpoint {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array kCrashes = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr std::size_t kHandlerStackSize = 64 * 1024;  // bytes

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

extern "C" void on_crash(int signal, siginfo_t* info, void*) {
  const bool wrote_to_image = signal == SIGSEGV && in_read_only_image(info->si_addr);
  const int what = wrote_to_image ? kWroteToImage : signal;
  if (current && !bookkeeping) siglongjmp(current->return_point, what);
  if (!current) end_plugin_thread(what, !calls_stages);
  if (wrote_to_image) write_to_stderr("error: a thread of a plugin wrote to an image of a frame\n");
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

extern "C" void on_give_up(int signal) {
  if (current && !bookkeeping) siglongjmp(current->return_point, signal);
}

extern "C" void on_exit_of_process() {
  if (guarded && current && !bookkeeping) siglongjmp(current->return_point, kExited);
  if (guarded && !current) end_plugin_thread(kExited, !calls_stages);
}

/// Before anything of a library that was loaded just now is destroyed.
void notice_exits_first() {
  if (guarded) std::atexit(on_exit_of_process);
}

/// The loader holds its lock: the call that needs the codecs is not ended meanwhile.
void load_image_codec(void (*load)()) {
  struct Bookkeeping {
    Bookkeeping() { bookkeeping = 1; }
    ~Bookkeeping() { bookkeeping = 0; }
  };
  {
    const Bookkeeping undisturbed;
    load();
  }
  notice_exits_first();
}

[[noreturn]] void fail(const Call& call, int what) {
  if (what == kGivenUp)
    if (auto ended = end_of_stopped_thread()) throw EndedCall(*ended);  // waited for it
  const std::string reason = reason_of(what);
  start_time_to_save(std::array{call.stage.c_str(), ": ", reason.c_str()});
  throw EndedCall(reason);
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string text_of(const Call& call) {
  const double seconds = seconds_since(call.start);
  std::ostringstream text;
  text << call.stage << " has not returned for " << std::fixed
       << std::setprecision(seconds < 9.95 ? 1 : 0) << seconds << " s";
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

void handle_crash(int signal) {
  struct sigaction action {};
  action.sa_sigaction = on_crash;
  action.sa_flags = SA_ONSTACK | SA_SIGINFO;
  sigaction(signal, &action, nullptr);
}

void handle_give_up() {
  struct sigaction action {};
  action.sa_handler = on_give_up;
  action.sa_flags = SA_ONSTACK;
  sigaction(kGivenUp, &action, nullptr);
}

}  // namespace

StageGuard::StageGuard() {
  prepare_for_plugin_threads();
  for (const int signal : kCrashes) handle_crash(signal);
  handle_give_up();
  watch_time_to_save();
  load_image_codec_with(load_image_codec);
  guarded = true;
  notice_exits_first();
}

StageGuard::~StageGuard() {
  guarded = false;
  end_time_to_save();
  for (const int signal : kCrashes) ::signal(signal, SIG_DFL);
  ::signal(kGivenUp, SIG_IGN);
}

void StageGuard::library_was_loaded(const void* address) {
  remember_plugin(address);
  notice_exits_first();
}

std::vector<std::string> StageGuard::calls_longer_than(double seconds) {
  std::vector<std::string> texts;
  const std::lock_guard all(calls_mutex);
  for (const Call* call : calls)
    if (seconds_since(call->start) > seconds) texts.push_back(text_of(*call));
  return texts;
}

std::size_t StageGuard::give_up(Time begun_before) {
  const std::lock_guard all(calls_mutex);
  return static_cast<std::size_t>(std::ranges::count_if(calls, [&](const Call* call) {
    return call->start < begun_before && pthread_kill(call->thread, kGivenUp) == 0;
  }));
}

bool StageGuard::is_in_call() { return current != nullptr; }

bool StageGuard::has_ended_a_call() { return has_started_to_save(); }

bool StageGuard::exists() { return guarded; }

LateCalls::LateCalls(double patience_seconds, Late late) {
  if (patience_seconds > 0)
    watcher_ =
        std::jthread([patience_seconds, late = std::move(late)](const std::stop_token& stop) {
          watch(stop, patience_seconds, late);
        });
}

EndedCall::EndedCall(const std::string& reason, std::string thread)
    : std::runtime_error(reason), thread_(std::move(thread)) {}

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
