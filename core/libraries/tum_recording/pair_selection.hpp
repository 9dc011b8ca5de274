// Which of the pairs of a recording are used: four options that sources share.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "stillpoint/error.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint::tum_recording {

struct PairSelection {
  int start = 0;   ///< first pair
  int end = 0;     ///< one past the last pair, 0 = all
  int stride = 1;  ///< every n-th pair
  int limit = 0;   ///< largest number of frames, 0 = no limit

  void visit(OptionVisitor& v) {
    v("start", start, {.min = 0, .unit = "pairs", .help = "first pair to use"});
    v("end", end, {.min = 0, .unit = "pairs", .help = "one past the last pair; 0 for all"});
    v("stride", stride, {.min = 1, .unit = "pairs", .help = "use every n-th pair"});
    v("limit", limit, {.min = 0, .unit = "frames", .help = "most frames to read; 0 for no limit"});
  }

  /// Keeps the pairs that are selected. Throws Error(kUsage), naming `recording`, when none is.
  template <class Pair>
  void apply(std::vector<Pair>& pairs, const std::string& recording) const {
    const std::size_t count = pairs.size();
    const std::size_t last = end > 0 ? std::min<std::size_t>(end, count) : count;
    std::vector<Pair> selected;
    for (std::size_t i = start; i < last; i += stride) {
      if (limit > 0 && selected.size() == static_cast<std::size_t>(limit)) break;
      selected.push_back(std::move(pairs[i]));
    }
    if (selected.empty())
      throw Error(
          Fault::kUsage,
          "no frames are selected of the " + std::to_string(count) + " pairs of the recording",
          recording, "change start, end, stride or limit");
    pairs = std::move(selected);
  }
};

}  // namespace stillpoint::tum_recording
