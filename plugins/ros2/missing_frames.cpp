#include "ros2/missing_frames.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stillpoint::ros2 {
namespace {

constexpr std::size_t kFewest = 9;         // intervals
constexpr double kUsualPeriod = 1 / 30.0;  // seconds

}  // namespace

void MissingFrames::add(double time) {
  if (any_ && time <= last_) return;
  if (std::exchange(any_, true)) intervals_.push_back(time - last_);
  last_ = time;
}

std::size_t MissingFrames::count() const {
  if (intervals_.size() < kFewest) return 0;
  const double expected = period();
  std::size_t missing = 0;
  for (const double interval : intervals_)
    missing += static_cast<std::size_t>(std::max(std::lround(interval / expected) - 1, 0L));
  return missing;
}

double MissingFrames::period() const {
  if (intervals_.empty()) return kUsualPeriod;
  std::vector<double> sorted = intervals_;
  const auto short_one = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 10);
  std::ranges::nth_element(sorted, short_one);
  return *short_one;
}

}  // namespace stillpoint::ros2
