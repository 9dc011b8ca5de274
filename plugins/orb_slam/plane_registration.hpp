// Point-to-plane registration of one depth view against others (Chen and Medioni 1992), linearised
// at a pose.
#pragma once

#include <span>

#include "orb_slam/depth_view.hpp"
#include "orb_slam/pose_solver.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

struct PlacedView {
  const DepthView* view;
  Pose world_from_camera = Pose::Identity();
};

struct PlaneRegistration {
  QuadraticCost cost;  ///< of the camera's pose
  int patches = 0;     ///< of the current view that were looked for
  int met = 0;         ///< of those, fall on a patch of another view
  int fitting = 0;     ///< of those, lie on its plane within reach

  /// Share of what is in the image that the other views know.
  double known() const { return patches > 0 ? static_cast<double>(met) / patches : 0.0; }
  /// Share of that which is where it should be.
  double agreement() const { return met > 0 ? static_cast<double>(fitting) / met : 0.0; }
};

/// Projective association: a patch of `current` is compared with the first of `others` that has one
/// where it falls, and counts when it is less than `reach` metres, or three standard deviations,
/// off its plane. Weighted by the noise of the sensor and by both static weights, and in all by no
/// more than `kMostPatches` full patches, since errors of neighbours are alike.
///
/// Directions in which the surfaces do not hold the camera are taken out of the cost, instead of
/// leaving them to the noise of normals (solution remapping: Zhang, Kaess and Singh, ICRA 2016).
PlaneRegistration register_planes(const DepthView& current, std::span<const PlacedView> others,
                                  const Pose& camera_from_world, double reach);

inline constexpr double kMostPatches = 150.0;

}  // namespace stillpoint::orb_slam
