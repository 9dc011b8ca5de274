// Ctrl-C as a stop token.
#pragma once

#include <stop_token>
#include <thread>

namespace stillpoint {

/// While it lives, the first SIGINT or SIGTERM requests a stop; the second one ends the process as
/// usual. One at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return stop_.get_token(); }
  /// The signal that came, or 0.
  static int signal();

 private:
  std::stop_source stop_;
  std::jthread watcher_;
};

}  // namespace stillpoint
