// How much of the images a run left out because it may move.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "figures/course.hpp"

namespace stillpoint::figures {

struct RunShare {
  std::string name;
  Course excluded;          ///< share of the pixels, 0 … 1
  std::vector<Range> lost;  ///< stretches of time without poses, s
};

/// As wide as a column.
Figure share_figure(std::span<const RunShare> runs);

}  // namespace stillpoint::figures
