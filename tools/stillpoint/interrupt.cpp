#include "interrupt.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

constexpr int kPatience = 1000;  // ms after the first signal
// Signals that come so soon after one are the same: `timeout` tells process and group, a terminal
// that ends shell and group.
constexpr std::int64_t kSame = 500;  // ms

// A signal handler may do little more than this: wake a thread that may do anything.
std::atomic<int> received{0};
std::atomic<int> signals{0};
std::atomic<std::int64_t> last_came{0};  // ms
std::atomic<int> wake_up{-1};            // an eventfd
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t milliseconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1000} * now.tv_sec + now.tv_nsec / 1'000'000;
}

void wake() {
  const int saved_errno = errno;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wake_up, &one, sizeof(one));
  errno = saved_errno;
}

extern "C" void on_signal(int signal) {
  const std::int64_t now = milliseconds();
  std::int64_t last = last_came;
  if (now - last < kSame || (signal == SIGHUP && signals > 0)) return;
  if (!last_came.compare_exchange_strong(last, now)) return;  // another thread has got the other
  received = signal;
  if (++signals == 3) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // comes when this handler returns
  }
  wake();
}

/// False when nobody has woken it up in time.
bool wait_for_wake_up(int milliseconds) {
  pollfd descriptor{.fd = wake_up, .events = POLLIN, .revents = 0};
  while (::poll(&descriptor, 1, milliseconds) < 0 && errno == EINTR) {
  }
  std::uint64_t times = 0;
  return (descriptor.revents & POLLIN) && ::read(wake_up, &times, sizeof(times)) > 0;
}

}  // namespace

Interrupt::Interrupt(std::function<void(const std::string& line)> say) {
  received = 0;
  signals = 0;
  last_came = milliseconds() - kSame;
  wake_up = ::eventfd(0, EFD_CLOEXEC);
  if (wake_up < 0) throw Error(Fault::kStage, "the system gives no eventfd to wait for Ctrl-C");
  watcher_ =
      std::jthread([this, say = std::move(say)](const std::stop_token& end) { watch(end, say); });
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hang_up {};
  sigaction(SIGHUP, nullptr, &hang_up);
  heeds_hang_up_ = hang_up.sa_handler != SIG_IGN;
  if (heeds_hang_up_) sigaction(SIGHUP, &action, nullptr);
}

Interrupt::~Interrupt() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  if (heeds_hang_up_) std::signal(SIGHUP, SIG_DFL);
  watcher_.request_stop();
  wake();
  watcher_.join();
  ::close(wake_up);
}

int Interrupt::signal() { return received; }

void Interrupt::watch(const std::stop_token& end,
                      const std::function<void(const std::string& line)>& say) {
  wait_for_wake_up(-1);
  if (end.stop_requested()) return;
  stop_.request_stop();
  if (signals < 2 && !wait_for_wake_up(kPatience)) {
    const std::vector<std::string> calls = StageGuard::calls_longer_than(1e-3 * kPatience);
    for (const std::string& text : calls) say(text + "; Ctrl-C again gives it up");
    if (calls.empty()) say("still stopping; Ctrl-C again ends it at once");
    wait_for_wake_up(-1);
  }
  if (end.stop_requested()) return;
  if (StageGuard::give_up() > 0) return;
  const int signal = received;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace stillpoint
