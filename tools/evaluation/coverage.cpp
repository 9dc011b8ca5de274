#include "evaluation/coverage.hpp"

#include <algorithm>
#include <vector>

#include "evaluation/association.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr double kGapIntervals = 3;

}  // namespace

double longest_interval(const Trajectory& trajectory) {
  return kGapIntervals * median_interval(trajectory);
}

SpanCoverage span_coverage(const Trajectory& reference, const Trajectory& estimate, double offset) {
  std::vector<double> times = times_of(estimate);
  const double longest = longest_interval(estimate);
  for (double& time : times) time = std::clamp(time + offset, reference.start(), reference.end());

  SpanCoverage result;
  double covered = 0;
  double previous = reference.start();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double interval = times[i] - previous;
    if (i > 0 && interval <= longest)
      covered += interval;
    else
      result.longest_gap_s = std::max(result.longest_gap_s, interval);
    previous = times[i];
  }
  result.longest_gap_s = std::max(result.longest_gap_s, reference.end() - previous);
  result.share = reference.duration() > 0 ? covered / reference.duration() : 0;
  return result;
}

FrameCoverage frame_coverage(std::span<const double> frame_times, const Trajectory& estimate,
                             double max_difference) {
  const std::vector<double> times = times_of(estimate);
  return {frame_times.size(), associate(frame_times, times, max_difference, 0).size()};
}

}  // namespace stillpoint::evaluation
