// The most frequent of many labels, in two numbers.
#pragma once

#include <cstdint>

namespace stillpoint {

/// Boyer and Moore, MJRTY (1991): right whenever one label makes up more than half of the votes.
struct MajorityVote {
  std::uint32_t lead = 0;  ///< of the winner over all others, so far
  std::uint8_t winner = 0;

  void add(std::uint8_t label, std::uint32_t votes = 1) {
    if (label == winner) {
      lead += votes;
    } else if (votes > lead) {
      winner = label;
      lead = votes - lead;
    } else {
      lead -= votes;
    }
  }
};

}  // namespace stillpoint
