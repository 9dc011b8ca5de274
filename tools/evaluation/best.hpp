// Which of several figures is the best.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace stillpoint::evaluation {

enum class Better { kSmaller, kLarger, kNeither };

/// A figure of a run. An error is one of the part of the recording that the run covers; what does
/// not depend on that, such as a time, counts as of all of it.
struct RatedFigure {
  double value = 0.0;
  double coverage_percent = 100.0;
  bool can_win = true;  ///< otherwise it counts as what others are to cover only
};

/// Percentage points. The error of a run that covers less of a recording than others, by more than
/// this, cannot be compared with theirs.
inline constexpr double kSameCoveragePercent = 1.0;

/// Of each figure, whether it reads, with so many digits behind the point, as the best among those
/// that cover as much as the one that covers most. None does when there is only one of these, or
/// all read the same.
std::vector<bool> best_of(std::span<const std::optional<RatedFigure>> figures, Better better,
                          int digits);

}  // namespace stillpoint::evaluation
