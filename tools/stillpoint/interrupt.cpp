#include "interrupt.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>

#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

// A signal handler may do little more than this: wake a thread that may do anything.
std::atomic<int> received{0};
std::atomic<int> wake_up{-1};  // an eventfd
static_assert(std::atomic<int>::is_always_lock_free);

void wake() {
  const int saved_errno = errno;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wake_up, &one, sizeof(one));
  errno = saved_errno;
}

extern "C" void on_signal(int signal) {
  received = signal;
  wake();
}

}  // namespace

Interrupt::Interrupt() {
  received = 0;
  wake_up = ::eventfd(0, EFD_CLOEXEC);
  if (wake_up < 0) throw Error(Fault::kStage, "the system gives no eventfd to wait for Ctrl-C");
  watcher_ = std::jthread([this] {
    std::uint64_t count = 0;
    while (::read(wake_up, &count, sizeof(count)) < 0 && errno == EINTR) {
    }
    if (received != 0) stop_.request_stop();
  });
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESETHAND | SA_RESTART;  // the second one ends the process
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

Interrupt::~Interrupt() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  wake();
  watcher_.join();
  ::close(wake_up);
}

int Interrupt::signal() { return received; }

}  // namespace stillpoint
