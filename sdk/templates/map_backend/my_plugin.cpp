#include "my_plugin.hpp"

#include <array>
#include <cmath>
#include <set>
#include <stillpoint/support/point_cloud_file.hpp>
#include <utility>

namespace plugins::my_plugin {

void MyPlugin::integrate(const stillpoint::DenseKeyFrame& keyframe) {
  const stillpoint::Frame& frame = *keyframe.frame;
  const cv::Mat weights = keyframe.map_weights(), labels = keyframe.labels();
  View view{.world_from_camera = keyframe.world_from_camera};
  for (int v = 0; v < frame.depth.rows; v += options_.step) {
    for (int u = 0; u < frame.depth.cols; u += options_.step) {
      const float depth = frame.depth.at<float>(v, u);
      if (!(depth > 0) || depth > options_.max_depth) continue;
      if (!weights.empty() && weights.at<std::uint8_t>(v, u) == 0) continue;  // it moves
      const auto& bgr = frame.bgr.at<cv::Vec3b>(v, u);
      view.in_camera.push_back(
          {.position = frame.camera->unproject(u, v, depth).cast<float>(),
           .rgb = {bgr[2], bgr[1], bgr[0]},
           .label = labels.empty() ? std::uint8_t{0} : labels.at<std::uint8_t>(v, u)});
    }
  }
  views_[keyframe.id] = std::move(view);
}

void MyPlugin::move(std::span<const stillpoint::MovedKeyFrame> moved) {
  for (const stillpoint::MovedKeyFrame& keyframe : moved)
    if (const auto view = views_.find(keyframe.keyframe); view != views_.end())
      view->second.world_from_camera = keyframe.world_from_camera;
}

/// The first point of each voxel, older key frames first.
std::vector<stillpoint::LabelledPoint> MyPlugin::occupied() const {
  std::vector<stillpoint::LabelledPoint> points;
  std::set<std::array<long, 3>> taken;
  for (const auto& [id, view] : views_) {
    const Eigen::Isometry3f world_from_camera = view.world_from_camera.cast<float>();
    for (stillpoint::LabelledPoint point : view.in_camera) {
      point.position = world_from_camera * point.position;
      std::array<long, 3> voxel{};
      for (int axis = 0; axis < 3; ++axis)
        voxel[static_cast<std::size_t>(axis)] =
            std::lround(std::floor(point.position[axis] / options_.voxel));
      if (taken.insert(voxel).second) points.push_back(point);
    }
  }
  return points;
}

void MyPlugin::save(const std::filesystem::path& directory) {
  stillpoint::write_ply(occupied(), classes_, directory / "my_plugin.ply");
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::MapBackend, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "a point cloud, one point per voxel"));
