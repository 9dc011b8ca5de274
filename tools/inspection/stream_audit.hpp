// One list of images or messages of a recording: how many, how fast, where some are missing.
#pragma once

#include <cstddef>
#include <vector>

namespace stillpoint::inspection {

struct Gap {
  double begin = 0.0;   ///< seconds, stamp of the last image before it
  double length = 0.0;  ///< seconds
};

struct StreamAudit {
  std::size_t images = 0;
  double begin = 0.0;     ///< seconds, first stamp
  double duration = 0.0;  ///< seconds
  double interval = 0.0;  ///< seconds, median
  std::vector<Gap> gaps;  ///< longest first: intervals of more than 1.5 times the median
};

/// `times` in seconds, in order.
StreamAudit audit_stream(const std::vector<double>& times);

}  // namespace stillpoint::inspection
