#include "map_voxel_cloud/voxel_cloud.hpp"

#include <cmath>

namespace stillpoint::map_voxel_cloud {
namespace {

constexpr int kBits = 21;                            // of a key, per axis
constexpr float kMaxCoordinate = 1U << (kBits - 1);  // voxels

}  // namespace

void VoxelCloud::add(const LabelledPoint& point, std::uint32_t count, bool labelled) {
  const Eigen::Vector3f voxel = (per_metre_ * point.position).array().floor();
  if (!(voxel.array().abs() < kMaxCoordinate).all()) return;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = key << kBits | static_cast<std::uint64_t>(voxel[axis] + kMaxCoordinate);
  const auto [place, is_new] = index_.try_emplace(key, static_cast<std::uint32_t>(sums_.size()));
  if (is_new) sums_.emplace_back();
  Sum& sum = sums_[place->second];
  sum.position += count * point.position.cast<double>();
  sum.rgb += count * Eigen::Vector3d(point.rgb[0], point.rgb[1], point.rgb[2]);
  sum.count += count;
  if (labelled) sum.label.add(point.label, count);
  sum.labelled |= labelled;
}

std::vector<VoxelPoint> VoxelCloud::points() const {
  std::vector<VoxelPoint> points;
  points.reserve(sums_.size());
  for (const Sum& sum : sums_) {
    const Eigen::Vector3d rgb = sum.rgb / sum.count;
    LabelledPoint mean{.position = (sum.position / sum.count).cast<float>(),
                       .label = sum.label.winner};
    for (int i = 0; i < 3; ++i) mean.rgb[i] = static_cast<std::uint8_t>(std::lround(rgb[i]));
    points.push_back({mean, sum.count, sum.labelled});
  }
  return points;
}

}  // namespace stillpoint::map_voxel_cloud
