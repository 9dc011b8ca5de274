// One list of images of a recording: how many, how fast, where some are missing.
#pragma once

#include <cstddef>
#include <vector>

#include "tum_recording/stamp_list.hpp"

namespace stillpoint::inspection {

using tum_recording::StampedImage;

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

/// `images` in order of time.
StreamAudit audit_stream(const std::vector<StampedImage>& images);

}  // namespace stillpoint::inspection
