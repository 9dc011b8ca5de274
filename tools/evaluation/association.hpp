// Which pose of one list belongs to which of another, by time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stillpoint::evaluation {

/// Indices into the two lists.
struct TimePair {
  std::size_t first, second;
};

/// Pairs with |first - (second + offset)| < max_difference, each element used at most once, the
/// closest pairs taken first (the benchmark's associate.py). Both lists rise strictly; so does the
/// result. All times in seconds.
std::vector<TimePair> associate(std::span<const double> first, std::span<const double> second,
                                double max_difference, double offset);

/// Index of the element of a rising list, not empty, that is closest to `value`. Of two equally
/// close ones it is the one a bisection meets first, as in the benchmark's evaluate_rpe.py.
std::size_t closest(std::span<const double> rising, double value);

}  // namespace stillpoint::evaluation
