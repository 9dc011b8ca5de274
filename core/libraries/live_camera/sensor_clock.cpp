#include "live_camera/sensor_clock.hpp"

#include <chrono>
#include <cmath>

namespace stillpoint::live_camera {
namespace {

constexpr double kJump = 1.0;  // seconds; images wait less than that in a driver
// Share of the difference to the time of arrival that each image makes up for: a device's clock
// runs faster or slower than this computer's, by up to 0.1 ms per second.
constexpr double kCorrection = 0.001;

double seconds_of(auto duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

double host_seconds() {
  using std::chrono::steady_clock;
  using std::chrono::system_clock;
  static const double offset = seconds_of(system_clock::now().time_since_epoch()) -
                               seconds_of(steady_clock::now().time_since_epoch());
  return offset + seconds_of(steady_clock::now().time_since_epoch());
}

SensorClock::SensorClock(double ticks_per_second, int bits)
    : ticks_per_second_(ticks_per_second), unused_bits_(64 - bits) {}

double SensorClock::seconds(std::uint64_t ticks, double arrival) {
  double seconds = arrival;
  if (last_) {
    // The difference of the counters as a signed number of their width, right when it starts over.
    const auto difference =
        static_cast<std::int64_t>((ticks - last_->ticks) << unused_bits_) >> unused_bits_;
    const double expected = last_->seconds + static_cast<double>(difference) / ticks_per_second_;
    if (std::abs(expected - arrival) < kJump)
      seconds = expected + kCorrection * (arrival - expected);
    else
      ++jumps_;
  }
  last_ = {ticks, seconds};
  return seconds;
}

}  // namespace stillpoint::live_camera
