// When neighbouring depths belong to different surfaces.
#pragma once

#include <algorithm>
#include <cmath>

namespace stillpoint {

/// Depths of one surface differ by its inclination, which between rays of some angle is a share of
/// the depth, and by the noise of the sensor, which grows with the square of the depth. More than
/// the larger of both is a depth discontinuity. How much that is depends on how far apart the
/// depths are: each place that asks has its own numbers.
struct DepthStep {
  float share;          ///< of the depth
  float sigmas = 0.0F;  ///< standard deviations of the depth

  /// Metres that another depth may be off one of `z` metres. `surface_noise` is that of the camera.
  float limit(float z, float surface_noise = 0.0F) const {
    return z * std::max(share, sigmas * surface_noise * z);
  }
  bool is_between(float z, float other, float surface_noise = 0.0F) const {
    return std::abs(other - z) > limit(z, surface_noise);
  }
};

}  // namespace stillpoint
