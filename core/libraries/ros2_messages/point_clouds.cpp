#include "ros2_messages/point_clouds.hpp"

namespace stillpoint::ros2_messages {

std::uint32_t rgb_of(const LabelledPoint& point) {
  const auto [red, green, blue] = point.rgb;
  return static_cast<std::uint32_t>(red << 16 | green << 8 | blue);
}

Eigen::Vector3f point_in_map(const Mounting& mounting, const Eigen::Vector3d& point_in_world) {
  return (mounting.map_from_world * point_in_world).cast<float>();
}

PointCloud landmark_cloud(const SparseMap& map, const Mounting& mounting, double time) {
  PointCloud cloud{{time, mounting.map}, {}, {}, {}};
  for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
    if (const Landmark* landmark = map.landmark(id))
      cloud.points.push_back(point_in_map(mounting, landmark->position_in_world));
  return cloud;
}

PointCloud dense_cloud(const std::vector<LabelledPoint>& points, const Mounting& mounting,
                       double time) {
  PointCloud cloud{{time, mounting.map}, {}, {}, {}};
  for (const LabelledPoint& point : points) {
    cloud.points.push_back(point_in_map(mounting, point.position.cast<double>()));
    cloud.rgb.push_back(rgb_of(point));
    cloud.classes.push_back(point.label);
  }
  return cloud;
}

}  // namespace stillpoint::ros2_messages
