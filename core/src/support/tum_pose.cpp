#include "stillpoint/support/tum_pose.hpp"

#include <array>
#include <cstdio>

namespace stillpoint {

void write_tum_pose(std::ostream& stream, double time, const Pose& world_from_camera) {
  Eigen::Quaterniond q(world_from_camera.linear());
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const Eigen::Vector3d t = world_from_camera.translation();
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), "%.6f %.7f %.7f %.7f %.8f %.8f %.8f %.8f\n", time, t.x(),
                t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  stream << line.data();
}

}  // namespace stillpoint
