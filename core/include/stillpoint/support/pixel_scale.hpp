// Lengths in pixels that belong to the scene or to the sensor, in images of any size.
#pragma once

#include <cmath>
#include <opencv2/core/types.hpp>

namespace stillpoint {

/// How many times as wide things are in an image of this size as in one of 640 × 480 pixels, with
/// the same angle of view: the square root of the ratio of their numbers of pixels.
///
/// A constant in pixels that stands for something in the scene or in the sensor, such as the shadow
/// beside a near surface, is meant for 640 × 480 and multiplied by this. What matching makes wide
/// (patches, search windows, the noise of a position) is as many pixels in every image; and so are
/// options, which are set for the images at hand.
inline double pixel_scale(cv::Size image) {
  constexpr double kPixels = 640.0 * 480.0;
  return std::sqrt(static_cast<double>(image.width) * image.height / kPixels);
}

}  // namespace stillpoint
