#include "live_camera/stream_period.hpp"

#include <algorithm>
#include <vector>

namespace stillpoint::live_camera {
namespace {

constexpr std::size_t kIntervals = 30;
constexpr std::size_t kShorterOnes = 6;  // the longest of the shortest sixth

}  // namespace

void StreamPeriod::add(double time) {
  if (last_ && time > *last_) intervals_.push_back(time - *last_);
  if (intervals_.size() > kIntervals) intervals_.pop_front();
  last_ = time;
}

std::optional<double> StreamPeriod::seconds() const {
  if (intervals_.empty()) return std::nullopt;
  std::vector<double> sorted(intervals_.begin(), intervals_.end());
  std::ranges::sort(sorted);
  return sorted[sorted.size() / kShorterOnes];
}

double pairing_limit(double max_difference, const StreamPeriod& color, const StreamPeriod& depth) {
  double limit = max_difference;
  for (const StreamPeriod* stream : {&color, &depth})
    if (const auto period = stream->seconds()) limit = std::min(limit, kLargestShare * *period);
  return limit;
}

}  // namespace stillpoint::live_camera
