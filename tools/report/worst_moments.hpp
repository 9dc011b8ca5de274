// When a run was worst.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/report_data.hpp"

namespace stillpoint::report {

struct WorstMoment {
  std::uint32_t frame = 0;
  std::string why;     ///< "largest error: 42.0 mm"
  bool first = false;  ///< the worst one of its kind
};

/// Of each kind (tracking is lost, largest error, most excluded, fewest inliers) the worst three,
/// at least a second apart: neighbours look alike. Empty without frames.csv.
std::vector<WorstMoment> worst_moments(const RunData& run);

}  // namespace stillpoint::report
