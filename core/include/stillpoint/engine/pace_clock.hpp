// The clock of `pace: sensor`. Tests replace it, so that they need not wait.
#pragma once

#include <stop_token>

#include "stillpoint/export.hpp"

namespace stillpoint {

class STILLPOINT_EXPORT PaceClock {
 public:
  virtual ~PaceClock() = default;
  virtual double now() = 0;  ///< seconds
  /// Returns at `time` (seconds) or after a stop.
  virtual void wait_until(double time, std::stop_token stop) = 0;
};

/// std::chrono::steady_clock: changes of the system time do not affect it.
class STILLPOINT_EXPORT SteadyClock final : public PaceClock {
 public:
  double now() override;
  void wait_until(double time, std::stop_token stop) override;
};

}  // namespace stillpoint
