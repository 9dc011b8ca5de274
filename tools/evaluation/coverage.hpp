// How much of a recording the estimate covers. An error without it means little: a tracker that
// gives up early is always accurate.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "evaluation/trajectory.hpp"

namespace stillpoint::evaluation {

/// Seconds between two successive poses, more than which is a gap: three times the median interval.
double longest_interval(const Trajectory& trajectory);

/// Share of the reference's time span during which there are estimated poses. Two successive poses
/// cover the time between them unless it is a gap.
struct SpanCoverage {
  double share = 0;          ///< 0 … 1
  double longest_gap_s = 0;  ///< without estimate, before the first and after the last included
};
SpanCoverage span_coverage(const Trajectory& reference, const Trajectory& estimate, double offset);

/// Share of the recording's frames that have an estimated pose of (almost) their time.
struct FrameCoverage {
  std::size_t frames = 0;
  std::size_t with_pose = 0;
  double share() const { return static_cast<double>(with_pose) / static_cast<double>(frames); }
};
FrameCoverage frame_coverage(std::span<const double> frame_times, const Trajectory& estimate,
                             double max_difference);

}  // namespace stillpoint::evaluation
