// Maps as sensor_msgs/PointCloud2; their headers are the caller's to fill in.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <stillpoint/contracts/labelled_point.hpp>
#include <vector>

namespace stillpoint_ros {

/// x, y, z (float32, metres) in the engine's world.
sensor_msgs::PointCloud2 landmark_cloud(const std::vector<Eigen::Vector3f>& positions);

/// x, y, z, `rgb` packed as RViz and PCL have it, and `label` (uint32), the class id.
sensor_msgs::PointCloud2 dense_cloud(const std::vector<stillpoint::LabelledPoint>& points);

}  // namespace stillpoint_ros
