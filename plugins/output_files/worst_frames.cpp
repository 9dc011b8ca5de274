#include "output_files/worst_frames.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "output_files/excluded.hpp"

namespace stillpoint::output_files {

std::optional<double> exclusion(const FrameReport& report) {
  const double share = excluded_share(report.weights.get());
  return share > 0.0 ? std::optional(share) : std::nullopt;
}

std::optional<double> lack_of_inliers(const FrameReport& report) {
  const TrackResult& result = report.result;
  if (result.state != TrackState::kTracking || result.matches == 0) return std::nullopt;
  return -static_cast<double>(result.inliers);
}

Badness loss() {
  return [tracked = false](const FrameReport& report) mutable -> std::optional<double> {
    const bool was_tracked = std::exchange(tracked, report.result.state == TrackState::kTracking);
    if (!was_tracked || tracked) return std::nullopt;
    return -static_cast<double>(report.frame->index);
  };
}

WorstFrames::Change WorstFrames::add(const FrameReport& report) {
  Change change;
  const double second = std::floor(report.frame->time);
  if (second != std::exchange(second_, second)) change = finish();
  const std::optional<double> badness = badness_(report);
  if (badness && (!worst_of_second_ || *badness > badness_of_second_)) {
    worst_of_second_ = report;
    badness_of_second_ = *badness;
  }
  return change;
}

WorstFrames::Change WorstFrames::finish() {
  Change change{.in = std::exchange(worst_of_second_, std::nullopt), .out = {}};
  if (!change.in) return change;
  const Bad bad{badness_of_second_, change.in->frame->index};
  kept_.insert(std::ranges::upper_bound(kept_, bad.badness, std::greater(), &Bad::badness), bad);
  if (kept_.size() <= count_) return change;
  const std::uint32_t least = kept_.back().frame;
  kept_.pop_back();
  if (least == bad.frame)
    change.in.reset();
  else
    change.out = least;
  return change;
}

}  // namespace stillpoint::output_files
