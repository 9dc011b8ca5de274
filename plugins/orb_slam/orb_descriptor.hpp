// Orientation and rotated BRIEF of a keypoint (Rublee et al., ICCV 2011, sections 3.2 and 4).
// Integer arithmetic but for a square root and divisions: the same bits on every machine.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillpoint/contracts/features.hpp"

namespace stillpoint::orb_slam {

/// Keypoints must lie this far inside the image.
inline constexpr int kPatchBorder = 19;

/// Rows must not be longer, in bytes.
inline constexpr int kMaxImageWidth = 32767;

/// A unit vector in 1/1024.
struct Direction {
  static constexpr int kOne = 1024;
  int cosine = kOne, sine = 0;
};

/// From (x, y) to the intensity centroid of the disc of radius 15 px around it; along x in a
/// flat disc. `gray` is CV_8UC1.
Direction patch_direction(const cv::Mat& gray, int x, int y);

/// 0 … 360 degrees, from x towards y; error below 0.001 degrees plus the resolution of Direction.
float angle_degrees(const Direction& direction);

/// The 256 tests, rotated by `direction`. `blurred` is CV_8UC1, smoothed with a Gaussian of 2 px.
Descriptor orb_descriptor(const cv::Mat& blurred, int x, int y, const Direction& direction);

}  // namespace stillpoint::orb_slam
