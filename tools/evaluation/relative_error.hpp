// Relative pose error (Sturm et al. 2012): how much the motion over a fixed interval is wrong, that
// is the drift. Needs no alignment.
#pragma once

#include <cstddef>
#include <optional>

#include "evaluation/statistics.hpp"
#include "evaluation/trajectory.hpp"

namespace stillpoint::evaluation {

enum class DeltaUnit { kSeconds, kFrames };

struct Delta {
  double length = 1.0;
  DeltaUnit unit = DeltaUnit::kSeconds;
};

struct RelativeError {
  std::size_t pairs = 0;
  Statistics translation_m;
  Statistics rotation_deg;
};

/// As the benchmark's evaluate_rpe.py with --fixed_delta: every estimated pose is paired with the
/// one closest to `delta` later, except where that is the last pose; both take the closest pose of
/// the reference, and pairs more than two reference intervals away from it are dropped. `offset`
/// (seconds) is added to the times of the estimate. Nothing when fewer than two pairs remain: the
/// recording is too short. Unlike the script, more than 10,000 pairs are not thinned out at random.
std::optional<RelativeError> relative_error(const Trajectory& reference, const Trajectory& estimate,
                                            const Delta& delta, double offset);

}  // namespace stillpoint::evaluation
