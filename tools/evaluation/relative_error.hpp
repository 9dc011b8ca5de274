// Relative pose error (Sturm et al. 2012): how much the motion over a fixed interval is wrong, that
// is the drift. Needs no alignment.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/statistics.hpp"
#include "evaluation/trajectory.hpp"

namespace stillpoint::evaluation {

enum class DeltaUnit { kSeconds, kFrames, kMetres /* along the estimated path */ };

/// "s", "f", "m", as the benchmark's script has them.
std::string symbol_of(DeltaUnit unit);
/// Throws Error(kUsage) for any other.
DeltaUnit delta_unit_of(const std::string& symbol);

struct Delta {
  double length = 1.0;
  DeltaUnit unit = DeltaUnit::kSeconds;
};

/// Of the motion that begins at `time`, on the reference's clock.
struct MotionError {
  double time = 0;  ///< seconds
  double translation_m = 0;
  double rotation_deg = 0;
};

struct RelativeError {
  std::size_t pairs = 0;
  /// Of these, whose interval is less than half a delta or more than one and a half: around losses,
  /// and between key frames. A pose may be paired with itself there, which is no error at all.
  std::size_t of_another_interval = 0;
  Statistics translation_m;
  Statistics rotation_deg;
  std::vector<MotionError> per_pair;  ///< by rising time
};

/// As the benchmark's evaluate_rpe.py with --fixed_delta and --delta_unit s, f or m: every
/// estimated pose is paired with the one closest to `delta` later, except where that is the last
/// pose; both take the closest pose of the reference, and pairs more than two reference intervals
/// away from it are dropped. `offset` (seconds) is added to the times of the estimate. Nothing when
/// fewer than two pairs remain: the recording is too short. Unlike the script, more than 10,000
/// pairs are not thinned out at random.
std::optional<RelativeError> relative_error(const Trajectory& reference, const Trajectory& estimate,
                                            const Delta& delta, double offset);

}  // namespace stillpoint::evaluation
