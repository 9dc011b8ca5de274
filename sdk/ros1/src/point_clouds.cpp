#include "point_clouds.hpp"

#include <sensor_msgs/point_cloud2_iterator.h>

namespace stillpoint_ros {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;
using Iterator = sensor_msgs::PointCloud2Iterator<float>;

void write_position(Iterator& to, const Eigen::Vector3f& position) {
  to[0] = position.x();
  to[1] = position.y();
  to[2] = position.z();
  ++to;
}

}  // namespace

PointCloud2 landmark_cloud(const std::vector<Eigen::Vector3f>& positions) {
  PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(3, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32);
  modifier.resize(positions.size());
  Iterator to(cloud, "x");
  for (const Eigen::Vector3f& position : positions) write_position(to, position);
  return cloud;
}

PointCloud2 dense_cloud(const std::vector<stillpoint::LabelledPoint>& points) {
  PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(5, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32, "rgb", 1, PointField::FLOAT32, "label", 1,
                                PointField::UINT32);
  modifier.resize(points.size());
  Iterator position(cloud, "x");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> bgr(cloud, "rgb");
  sensor_msgs::PointCloud2Iterator<std::uint32_t> label(cloud, "label");
  for (const stillpoint::LabelledPoint& point : points) {
    write_position(position, point.position);
    for (int i = 0; i < 3; ++i) bgr[i] = point.rgb[static_cast<std::size_t>(2 - i)];
    *label = point.label;
    ++bgr;
    ++label;
  }
  return cloud;
}

}  // namespace stillpoint_ros
