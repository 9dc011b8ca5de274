// When a camera took an image, on this computer's clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

namespace stillpoint::live_camera {

/// Seconds since 1970 of this computer, read once and counted on by the steady clock: setting the
/// computer's clock during a run changes nothing.
double host_seconds();

/// Turns the counter of a device into seconds of host_seconds(). Between two images its difference
/// is good to microseconds, while the times of arrival at the computer vary by milliseconds. Over
/// minutes it follows the times of arrival: the two clocks do not run alike. Not thread-safe, but
/// for jumps().
class SensorClock {
 public:
  /// A counter of `bits` bits, at most 64, that starts over at its end.
  SensorClock(double ticks_per_second, int bits);

  /// The time of an image with this counter that arrives at `arrival`, seconds of host_seconds().
  /// Images of two streams may come a little out of order. A counter that is more than a second
  /// away from what the computer's clock says has been reset, or the device was away: it is
  /// compared anew.
  double seconds(std::uint64_t ticks, double arrival);

  /// The device begins anew: the next image is compared with the computer's clock. This is no jump.
  void restart() { last_.reset(); }

  /// How often the counter did not go on as expected.
  int jumps() const { return jumps_; }

 private:
  struct Reading {
    std::uint64_t ticks;
    double seconds;
  };

  double ticks_per_second_;
  int unused_bits_;  // above those of the counter
  std::optional<Reading> last_;
  std::atomic<int> jumps_ = 0;
};

}  // namespace stillpoint::live_camera
