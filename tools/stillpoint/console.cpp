#include "console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <iostream>

namespace stillpoint {
namespace {

constexpr const char* kClearLine = "\r\033[K";

}  // namespace

Console::Console() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

int Console::columns() const {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

void Console::line(const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (!status_.empty()) std::cerr << kClearLine;
  std::cerr << text << '\n' << status_ << std::flush;
}

void Console::status(const std::string& text) {
  if (!is_terminal_) return;
  const std::lock_guard lock(mutex_);
  status_ = text;
  std::cerr << kClearLine << status_ << std::flush;
}

}  // namespace stillpoint
