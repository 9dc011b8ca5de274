// How an image is exposed.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// The smallest level that `share` of the values of an 8-bit image do not exceed; all channels
/// count. 0 for an empty image.
STILLPOINT_EXPORT int level_quantile(const cv::Mat& image, double share);

/// Of the values of an image; the others may be lamps and reflections.
constexpr double kNotBrightest = 0.99;
/// An image whose level_quantile(kNotBrightest) is smaller is dark.
constexpr int kDarkLevel = 96;

}  // namespace stillpoint
