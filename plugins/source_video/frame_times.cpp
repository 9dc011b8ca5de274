#include "source_video/frame_times.hpp"

#include <string>

#include "stillpoint/error.hpp"
#include "tum_recording/stamp_list.hpp"

namespace stillpoint::source_video {

FrameTimes::FrameTimes(const std::filesystem::path& list) {
  for (const tum_recording::ListLine& line : tum_recording::read_list_lines(list)) {
    const double time = tum_recording::stamp_of(line, 0, list);
    if (!times_.empty() && time <= times_.back())
      throw Error(Fault::kData, "this time is not later than the one before",
                  list.string() + ":" + std::to_string(line.number));
    times_.push_back(time);
  }
  if (times_.empty()) throw Error(Fault::kData, "there is no time in this list", list.string());
}

std::optional<double> FrameTimes::at(std::size_t index) const {
  if (rate_ > 0) return first_ + static_cast<double>(index) / rate_;
  return index < times_.size() ? std::optional(times_[index]) : std::nullopt;
}

std::optional<std::size_t> FrameTimes::size() const {
  return rate_ > 0 ? std::nullopt : std::optional(times_.size());
}

}  // namespace stillpoint::source_video
