// Maps as point clouds.
#pragma once

#include <vector>

#include "ros2_messages/messages.hpp"
#include "ros2_messages/mounting.hpp"
#include "stillpoint/contracts/labelled_point.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::ros2_messages {

/// 0x00RRGGBB.
std::uint32_t rgb_of(const LabelledPoint& point);

/// Points of the world in the map, metres.
Eigen::Vector3f point_in_map(const Mounting& mounting, const Eigen::Vector3d& point_in_world);

PointCloud landmark_cloud(const SparseMap& map, const Mounting& mounting, double time);

/// With colours and classes.
PointCloud dense_cloud(const std::vector<LabelledPoint>& points, const Mounting& mounting,
                       double time);

}  // namespace stillpoint::ros2_messages
