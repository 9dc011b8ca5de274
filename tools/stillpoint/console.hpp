// Standard error as a run uses it: lines of text, and on a terminal a status line below them.
#pragma once

#include <mutex>
#include <string>

namespace stillpoint {

/// "4:07", minutes and seconds.
std::string minutes(double seconds);

/// May be used from any thread. Where nobody reads standard error, a line is lost after a second,
/// others and status lines at once, until somebody does: a run goes on, and its log.txt has the
/// warnings.
class Console {
 public:
  /// Quiet: without notes and status lines.
  explicit Console(bool quiet = false);

  bool is_terminal() const { return is_terminal_; }
  /// Of the terminal as it is now: a status line must not be longer.
  int columns() const;
  void line(const std::string& text);
  /// A line that is left out when quiet.
  void note(const std::string& text);
  /// Replaces the status line; empty: removes it. Does nothing without a terminal.
  void status(const std::string& text);

 private:
  const bool quiet_;
  const bool is_terminal_;
  std::mutex mutex_;
  std::string status_;   // guarded by mutex_
  bool is_read_ = true;  // guarded: whether the last line was taken
};

}  // namespace stillpoint
