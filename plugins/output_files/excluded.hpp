// How much of a frame tracking leaves out.
#pragma once

#include <opencv2/core.hpp>
#include <stillpoint/sdk.hpp>

namespace stillpoint::output_files {

/// Share of the pixels, each as much as its weight is below that of a static one.
inline double excluded_share(const StaticWeights* weights) {
  if (!weights || weights->track.empty()) return 0.0;
  return 1.0 - cv::mean(weights->track)[0] / 255.0;
}

}  // namespace stillpoint::output_files
