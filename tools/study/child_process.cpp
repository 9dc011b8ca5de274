#include "study/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "stillpoint/error.hpp"

namespace stillpoint::study {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kCannotStart = 127;
constexpr double kSecondsToSave = 10.0;  // after SIGINT

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// Signals of the calling thread wait while it lives: between fork and exec, the parent's handlers
/// would run in the child.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { release(); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;
  void release() const { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

// Other threads may hold any lock: nothing but system calls here.
[[noreturn]] void become(char* const* arguments, const char* console, pid_t parent,
                         const BlockedSignals& blocked) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kCannotStart);  // it ended before it could be told
  const int input = open("/dev/null", O_RDONLY);
  const int output = open(console, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (input < 0 || output < 0) _exit(kCannotStart);
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  blocked.release();
  execv(arguments[0], arguments);
  _exit(kCannotStart);
}

pid_t start(std::vector<std::string>& command, const std::filesystem::path& console) {
  const std::vector<char*> arguments = pointers(command);
  const pid_t parent = getpid();
  const BlockedSignals blocked;
  const pid_t process = fork();
  if (process == 0) become(arguments.data(), console.c_str(), parent, blocked);
  if (process < 0)
    throw Error(Fault::kStage, std::string("cannot start a process: ") + std::strerror(errno),
                command.front());
  return process;
}

/// Whether it ends within the time.
bool ends_within(pid_t process, double seconds) {
  // The header of glibc 2.36 declares pidfd_open() for C only.
  const int file = static_cast<int>(syscall(SYS_pidfd_open, process, 0));
  if (file < 0) return true;  // no such call before Linux 5.3: it is waited for without a limit
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  pollfd ended{.fd = file, .events = POLLIN, .revents = 0};
  const auto left_ms = [&] {
    return std::chrono::duration<double, std::milli>(end - Clock::now()).count();
  };
  // A wait may be interrupted; one of many days does not fit into an int.
  while (poll(&ended, 1, static_cast<int>(std::clamp(left_ms(), 0.0, 1e9))) <= 0 &&
         left_ms() > 0.0) {
  }
  close(file);
  return (ended.revents & POLLIN) != 0;
}

}  // namespace

ProcessEnd run_process(std::vector<std::string> command, const std::filesystem::path& console,
                       const std::stop_token& stop, double time_limit) {
  const pid_t process = start(command, console);
  ProcessEnd end;
  {
    const std::stop_callback interrupt(stop, [process] { kill(process, SIGINT); });
    if (time_limit > 0.0 && !ends_within(process, time_limit)) {
      end.in_time = false;
      kill(process, SIGINT);
      if (!ends_within(process, kSecondsToSave)) kill(process, SIGKILL);
    }
    // Not reaped yet: until the callback is gone, the number belongs to this process.
    siginfo_t info{};
    while (waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOWAIT) < 0 &&
           errno == EINTR) {
    }
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end.exit_code = end.signal != 0 ? 128 + end.signal : WEXITSTATUS(status);
  return end;
}

std::filesystem::path this_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

}  // namespace stillpoint::study
