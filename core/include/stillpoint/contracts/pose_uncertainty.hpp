// How well a camera's pose is known.
#pragma once

#include "stillpoint/export.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint {

/// Relative to the map: errors of the map itself are not included.
struct PoseUncertainty {
  /// Of the camera in its own frame: x, y, z (metres), then the rotation about them (radians).
  /// A direction that no measurement constrains has a standard deviation of 1 m or 1 rad.
  Matrix6d covariance = Matrix6d::Identity();

  /// A pose is poorly constrained when its standard deviation in any direction is larger than 5 cm,
  /// or 0.05 rad about any axis: the camera may have slid along a plane, or turned, unseen. The
  /// same for all, so that counts of different trackers can be compared; the covariance says more.
  static constexpr double kMaxMetres = 0.05;
  static constexpr double kMaxRadians = 0.05;

  /// Standard deviation in the direction where it is largest.
  STILLPOINT_EXPORT double metres() const;
  STILLPOINT_EXPORT double radians() const;
  bool poorly_constrained() const { return metres() > kMaxMetres || radians() > kMaxRadians; }
};

}  // namespace stillpoint
