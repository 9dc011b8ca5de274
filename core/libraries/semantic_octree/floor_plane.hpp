// The floor that a map stands on.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace stillpoint::semantic_octree {

/// All points x with up · x = height are on the floor.
struct FloorPlane {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit length, away from gravity
  double height = 0;                              ///< metres
};

/// Where the first camera looks, along the floor; another direction when it looks straight up or
/// down.
inline Eigen::Vector3d ahead_on_floor(const Eigen::Vector3d& up) {
  Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ() - up.z() * up;
  if (ahead.norm() < 0.1) ahead = Eigen::Vector3d::UnitX() - up.x() * up;
  return ahead.normalized();
}

/// The lowest of the large horizontal surfaces, on which nothing stands, among the points of a map,
/// each of an area of about `spacing`². Horizontal is what has most points in one plane whose
/// normal is within 50° of `up_hint`; the camera's own up at the first frame is good enough. The
/// same points give the same plane. Empty when there is no such surface of half a square metre.
std::optional<FloorPlane> find_floor(std::span<const Eigen::Vector3f> points,
                                     const Eigen::Vector3d& up_hint, double spacing);

/// Likewise with a direction that is known from gravity.
std::optional<FloorPlane> find_floor_below(std::span<const Eigen::Vector3f> points,
                                           const Eigen::Vector3d& up, double spacing);

}  // namespace stillpoint::semantic_octree
