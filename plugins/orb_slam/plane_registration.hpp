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
  QuadraticCost cost;    ///< of the camera's pose
  int patches = 0;       ///< of the current view that were projected
  int matched = 0;       ///< of those, fall on a patch of another view
  int inlier_count = 0;  ///< of those, lie on its plane within reach

  /// Share of the patches that the other views cover.
  double overlap() const { return patches > 0 ? static_cast<double>(matched) / patches : 0.0; }
  /// Inlier share of those.
  double agreement() const {
    return matched > 0 ? static_cast<double>(inlier_count) / matched : 0.0;
  }
};

/// Projective association: a patch of `current` is compared with the first of `others` that has one
/// where it falls, and counts when it is less than `reach` metres, or three standard deviations,
/// off its plane. Weighted by the noise of the sensor and by both static weights, in total by no
/// more than `kMaxPatches` patches of full weight, since errors of neighbours are correlated.
///
/// Directions in which the surfaces do not constrain the camera are removed from the cost, instead
/// of leaving them to the noise of normals (solution remapping: Zhang, Kaess and Singh, ICRA 2016).
PlaneRegistration register_planes(const DepthView& current, std::span<const PlacedView> others,
                                  const Pose& camera_from_world, double reach);

inline constexpr double kMaxPatches = 150.0;

}  // namespace stillpoint::orb_slam
