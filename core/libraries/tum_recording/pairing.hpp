// Which depth image belongs to which colour image.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stillpoint::tum_recording {

struct IndexPair {
  std::size_t color = 0;
  std::size_t depth = 0;
  friend bool operator==(const IndexPair&, const IndexPair&) = default;
};

/// Pairs of stamps less than `max_difference` seconds apart, each stamp used once, the closest
/// pairs chosen first (of equally close ones the earlier), as the TUM benchmark's associate.py
/// does. Both lists must be strictly increasing. The result is ordered by colour index.
std::vector<IndexPair> pair_by_time(std::span<const double> color, std::span<const double> depth,
                                    double max_difference);

}  // namespace stillpoint::tum_recording
