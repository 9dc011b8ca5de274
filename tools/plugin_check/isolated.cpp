#include "plugin_check/isolated.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sstream>
#include <vector>

#include "stillpoint/error.hpp"

namespace stillpoint::plugin_check {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kConsoleLines = 15;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail(const char* what) {
  throw Error(Fault::kStage, std::string(what) + ": " + std::strerror(errno), "plugins check");
}

volatile std::sig_atomic_t interrupting_signal = 0;
extern "C" void on_interrupt(int signal) { interrupting_signal = signal; }

/// While it lives, SIGINT and SIGTERM end a wait() and not the process. They come during a wait()
/// only, so that none is missed.
class InterruptibleWait {
 public:
  InterruptibleWait() {
    interrupting_signal = 0;
    sigset_t held;
    sigemptyset(&held);
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      sigaddset(&held, kSignals[i]);
      sigaction(kSignals[i], &action, &before_[i]);
    }
    sigprocmask(SIG_BLOCK, &held, &mask_);
  }
  ~InterruptibleWait() { restore(); }
  InterruptibleWait(const InterruptibleWait&) = delete;
  InterruptibleWait& operator=(const InterruptibleWait&) = delete;

  /// For the child, too.
  void restore() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
    sigprocmask(SIG_SETMASK, &mask_, nullptr);
  }
  /// Whether `file` can be read from. False: not in time, or interrupted.
  bool wait(int file, std::chrono::nanoseconds time) const {
    pollfd ready{.fd = file, .events = POLLIN, .revents = 0};
    const timespec limit{.tv_sec = time.count() / 1'000'000'000,
                         .tv_nsec = time.count() % 1'000'000'000};
    return ::ppoll(&ready, 1, &limit, &mask_) > 0;
  }

 private:
  static constexpr std::array kSignals = {SIGINT, SIGTERM};

  std::array<struct sigaction, 2> before_{};
  sigset_t mask_{};
};

[[noreturn]] void be_the_child(const std::function<std::string()>& function, int pipe,
                               std::FILE* console) {
  ::dup2(::fileno(console), STDOUT_FILENO);
  ::dup2(::fileno(console), STDERR_FILENO);
  int exit_code = 1;
  try {
    const std::string result = function();
    std::size_t written = 0;
    while (written < result.size()) {
      const auto more = ::write(pipe, result.data() + written, result.size() - written);
      if (more <= 0) break;
      written += static_cast<std::size_t>(more);
    }
    exit_code = 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  } catch (...) {
    std::fputs("an exception of unknown type\n", stderr);
  }
  std::fflush(nullptr);
  ::_exit(exit_code);  // nothing of the plugin is run any more
}

/// What the child writes until it ends; false when it takes longer than `seconds`, or interrupted.
bool read_all(const InterruptibleWait& wait, int pipe, double seconds, std::string& text) {
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::array<char, 4096> buffer{};
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(end - Clock::now());
    if (left.count() <= 0 || !wait.wait(pipe, left)) return false;
    const auto read = ::read(pipe, buffer.data(), buffer.size());
    if (read <= 0) return true;
    text.append(buffer.data(), static_cast<std::size_t>(read));
  }
}

bool begins_a_report(const std::string& line) {
  return line.find("Sanitizer: ") != std::string::npos ||
         line.find(": runtime error: ") != std::string::npos;
}

/// The end of what was printed; of a sanitizer's report the beginning, since it ends with a legend.
std::string telling_lines(std::FILE* console) {
  std::rewind(console);
  std::vector<std::string> lines;
  std::string line;
  bool is_report = false;
  for (int c = std::fgetc(console); c != EOF; c = std::fgetc(console)) {
    line += static_cast<char>(c);
    if (c != '\n') continue;
    if (!is_report && begins_a_report(line)) {
      is_report = true;
      lines.clear();
    }
    if (lines.size() == kConsoleLines) {
      if (is_report) break;
      lines.erase(lines.begin());
    }
    lines.push_back(std::move(line));
    line.clear();
  }
  if (!line.empty() && !is_report) lines.push_back(line + '\n');
  std::string text;
  for (const std::string& one : lines) text += one;
  return text;
}

}  // namespace

IsolatedEnd run_isolated(const std::function<std::string()>& function, double seconds) {
  const File console(std::tmpfile());
  std::array<int, 2> pipe{};
  if (!console || ::pipe(pipe.data()) != 0) fail("no temporary file or pipe");
  std::fflush(nullptr);
  InterruptibleWait wait;
  const pid_t child = ::fork();
  if (child < 0) fail("no process");
  if (child == 0) {
    wait.restore();
    ::close(pipe[0]);
    be_the_child(function, pipe[1], console.get());
  }
  ::close(pipe[1]);
  IsolatedEnd end;
  std::string result;
  const bool in_time = read_all(wait, pipe[0], seconds, result);
  ::close(pipe[0]);
  if (!in_time) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (interrupting_signal != 0) throw Interrupted(interrupting_signal);
  end.console = telling_lines(console.get());
  if (!in_time) {
    std::ostringstream text;
    text << "it did not end within " << seconds << " s (--timeout)";
    end.how = text.str();
  } else if (WIFSIGNALED(status)) {
    end.how = std::string("a thread of its own was ended by SIG") + sigabbrev_np(WTERMSIG(status)) +
              ", " + sigdescr_np(WTERMSIG(status));
  } else if (WEXITSTATUS(status) != 0) {
    end.how = "it ended the process with exit code " + std::to_string(WEXITSTATUS(status));
  } else {
    end.result = std::move(result);
  }
  return end;
}

}  // namespace stillpoint::plugin_check
