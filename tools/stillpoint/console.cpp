#include "console.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <iostream>

namespace stillpoint {
namespace {

constexpr const char* kClearLine = "\r\033[K";
constexpr int kLineWait = 1000;  // ms that a line waits for whoever reads it

/// Whether what is written now would not have to wait: a terminal that was halted with Ctrl-S, or a
/// pipe that nobody reads, must not stop the run.
bool takes_text(int milliseconds) {
  pollfd error_stream{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
  int ready = 0;
  while ((ready = ::poll(&error_stream, 1, milliseconds)) < 0 && errno == EINTR) continue;
  return ready != 0;
}

}  // namespace

std::string minutes(double seconds) {
  const long whole = std::lround(seconds);
  return std::to_string(whole / 60) + ":" + (whole % 60 < 10 ? "0" : "") +
         std::to_string(whole % 60);
}

Console::Console(bool quiet) : quiet_(quiet), is_terminal_(isatty(STDERR_FILENO) == 1) {}

int Console::columns() const {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

void Console::line(const std::string& text) {
  const std::lock_guard lock(mutex_);
  is_read_ = takes_text(is_read_ ? kLineWait : 0);
  if (!is_read_) return;
  if (!status_.empty()) std::cerr << kClearLine;
  std::cerr << text << '\n' << status_ << std::flush;
}

void Console::note(const std::string& text) {
  if (!quiet_) line(text);
}

void Console::status(const std::string& text) {
  if (quiet_ || !is_terminal_) return;
  const std::lock_guard lock(mutex_);
  if (!takes_text(0)) return;
  status_ = text;
  std::cerr << kClearLine << status_ << std::flush;
}

}  // namespace stillpoint
