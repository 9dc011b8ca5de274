// Ctrl-C as a stop token.
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <thread>

namespace stillpoint {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP (the terminal is gone; unless nohup ignores
/// it) requests a stop; when that takes more than a second, `say` is told what it waits for. The
/// second one gives up the stages under way (see StageGuard), or ends the process as usual when
/// there are none; so does the third in any case. Signals within half a second count as one. One
/// object at a time.
class Interrupt {
 public:
  explicit Interrupt(std::function<void(const std::string& line)> say);
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return stop_.get_token(); }
  /// The signal that came, or 0.
  static int signal();

 private:
  void watch(const std::stop_token& end, const std::function<void(const std::string& line)>& say);

  std::stop_source stop_;
  bool heeds_hang_up_ = true;
  std::jthread watcher_;
};

}  // namespace stillpoint
