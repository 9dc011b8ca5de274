// The floor under a map.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

/// All points x with up · x = height.
struct Floor {
  Eigen::Vector3f up = Eigen::Vector3f::UnitZ();  ///< unit length
  float height = 0;                               ///< metres
};

/// The lowest of the large horizontal surfaces among points of surfaces that face `up` more or
/// less. What is horizontal, the plane with most points says. Nothing when there is no plane.
std::optional<Floor> find_floor(const std::vector<Eigen::Vector3f>& points,
                                const Eigen::Vector3f& up);
