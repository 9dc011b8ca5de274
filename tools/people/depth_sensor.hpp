// What a structured-light sensor measures of what is pasted before a scene it has measured already.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace stillpoint::people {

/// Puts `z` (CV_32F, m; 0: nothing pasted) into `depth` (CV_32F, m; 0 = no measurement): disparity
/// noise, part of which neighbours share, and its steps; holes at outlines; no measurement nearer
/// than 0.4 m; in the shadow left of what is pasted, where the projector's light does not come,
/// none of the scene either.
void measure(const cv::Mat& z, std::uint32_t seed, std::uint32_t frame, cv::Mat& depth);

}  // namespace stillpoint::people
