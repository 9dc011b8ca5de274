// Long series, made short enough for a page.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stillpoint::report {

/// Indices of at most `limit` elements, rising: of each of as many equal parts the one for which
/// `importance(index)` is largest, so that no peak is lost.
template <class Importance>
std::vector<std::size_t> thinned(std::size_t size, std::size_t limit, Importance importance) {
  std::vector<std::size_t> kept;
  const std::size_t parts = std::min(size, limit);
  for (std::size_t part = 0; part < parts; ++part) {
    std::size_t best = part * size / parts;
    for (std::size_t i = best + 1; i < (part + 1) * size / parts; ++i)
      if (importance(i) > importance(best)) best = i;
    kept.push_back(best);
  }
  return kept;
}

}  // namespace stillpoint::report
