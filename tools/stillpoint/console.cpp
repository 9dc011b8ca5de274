#include "console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <iostream>

namespace stillpoint {
namespace {

constexpr const char* kClearLine = "\r\033[K";

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
  if (!status_.empty()) std::cerr << kClearLine;
  std::cerr << text << '\n' << status_ << std::flush;
}

void Console::note(const std::string& text) {
  if (!quiet_) line(text);
}

void Console::status(const std::string& text) {
  if (quiet_ || !is_terminal_) return;
  const std::lock_guard lock(mutex_);
  status_ = text;
  std::cerr << kClearLine << status_ << std::flush;
}

}  // namespace stillpoint
