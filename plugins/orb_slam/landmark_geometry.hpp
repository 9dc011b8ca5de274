// Properties of a landmark that follow from its observations, and their reprojection errors.
#pragma once

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

/// Recomputes mean viewing direction, descriptor and range of distances from the observations.
/// Does nothing when the landmark is gone.
void refresh_landmark(MapEdit& edit, LandmarkId id);

/// Squared, normalised error of an observation and the 95 % bound of its chi-square test. Infinite
/// when the point is behind the camera.
struct ObservationError {
  double squared = 0.0;
  double bound = 0.0;
  bool fits() const { return squared <= bound; }
};
ObservationError observation_error(const Eigen::Vector3d& point_in_world,
                                   const Pose& camera_from_world, const KeyFrame& keyframe,
                                   std::uint32_t feature);

/// The same for the observation of a key frame of the map.
bool observation_fits(const SparseMap& map, const Eigen::Vector3d& point_in_world,
                      const Observation& observation);
/// Removes outlier observations; with its last observation the landmark is removed.
void remove_outlier_observations(MapEdit& edit, LandmarkId id);

/// Features with less weight than this do not become landmarks.
inline constexpr std::uint8_t kMinMapWeight = 128;

}  // namespace stillpoint::orb_slam
