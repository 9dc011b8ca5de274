#include "map_voxel_cloud/voxel_cloud_backend.hpp"
#include "stillpoint/support/point_cloud_file.hpp"

namespace stillpoint::map_voxel_cloud {

void VoxelCloudBackend::Options::visit(OptionVisitor& v) {
  v("resolution", resolution, {.min = 0.005, .max = 1, .unit = "m", .help = "edge of a voxel"});
  v("range", range,
    {.min = 0.5, .max = 20, .unit = "m", .help = "surfaces farther from the camera are left out"});
  v("min_points", min_points,
    {.min = 1, .max = 1000, .help = "points that a voxel needs; with fewer it is left out"});
  v("min_weight", min_weight,
    {.min = 1, .max = 255, .help = "least map weight of pixels that are mapped"});
}

void VoxelCloudBackend::integrate(const DenseKeyFrame& keyframe) {
  const Frame& frame = *keyframe.frame;
  const cv::Mat labels = keyframe.labels(), weights = keyframe.map_weights();
  VoxelCloud cloud(options_.resolution);
  for (int v = 0; v < frame.depth.rows; ++v) {
    const auto* depth = frame.depth.ptr<float>(v);
    const auto* bgr = frame.bgr.ptr<cv::Vec3b>(v);
    const auto* label = labels.empty() ? nullptr : labels.ptr<std::uint8_t>(v);
    const auto* weight = weights.empty() ? nullptr : weights.ptr<std::uint8_t>(v);
    for (int u = 0; u < frame.depth.cols; ++u) {
      if (!(depth[u] > 0) || depth[u] > options_.range) continue;
      if (weight && weight[u] < options_.min_weight) continue;
      cloud.add({.position = frame.camera->unproject(u, v, depth[u]).cast<float>(),
                 .rgb = {bgr[u][2], bgr[u][1], bgr[u][0]},
                 .label = label ? label[u] : std::uint8_t{0}},
                1, label != nullptr);
    }
  }
  entries_[keyframe.id] = {keyframe.world_from_camera, cloud.points()};
}

void VoxelCloudBackend::move(std::span<const MovedKeyFrame> moved) {
  for (const MovedKeyFrame& keyframe : moved)
    if (const auto found = entries_.find(keyframe.keyframe); found != entries_.end())
      found->second.world_from_camera = keyframe.world_from_camera;
}

void VoxelCloudBackend::save(const std::filesystem::path& directory) {
  write_ply(occupied(), classes_, directory / "cloud.ply");
}

std::vector<LabelledPoint> VoxelCloudBackend::occupied() const {
  std::vector<LabelledPoint> cloud;
  for (const VoxelPoint& point : points()) cloud.push_back(point.mean);
  return cloud;
}

std::vector<VoxelPoint> VoxelCloudBackend::points() const {
  VoxelCloud world(options_.resolution);
  for (const auto& [id, entry] : entries_) {
    const Eigen::Isometry3f pose = entry.world_from_camera.cast<float>();
    for (const VoxelPoint& point : entry.points) {
      LabelledPoint moved = point.mean;
      moved.position = pose * moved.position;
      world.add(moved, point.count, point.labelled);
    }
  }
  std::vector<VoxelPoint> points = world.points();
  std::erase_if(points, [&](const VoxelPoint& point) {
    return point.count < static_cast<std::uint32_t>(options_.min_points);
  });
  return points;
}

}  // namespace stillpoint::map_voxel_cloud
