#include "height_map.hpp"

#include <cmath>
#include <utility>

namespace {

constexpr int kMinWeight = 128;       // of a pixel: what is static and may be mapped
constexpr double kMinCosine = 0.7;    // between `kUp` and the normal of what may be floor
constexpr int kReach = 6;             // px, to the neighbours that a normal is made of
constexpr double kFlatness = 0.004;   // metres at 1 m, from a point to the middle of its neighbours
const Eigen::Vector3d kUp(0, -1, 0);  // of the first camera, whose frame is the world

std::optional<Eigen::Vector3d> point_at(const stillpoint::Frame& frame, int x, int y) {
  if (!cv::Rect({}, frame.depth.size()).contains({x, y})) return std::nullopt;
  const float depth = frame.depth.at<float>(y, x);
  if (!(depth > 0)) return std::nullopt;
  return frame.camera->unproject(x, y, depth);
}

/// Of the surface, towards the camera; zero where it is not flat or not known.
Eigen::Vector3d normal_at(const stillpoint::Frame& frame, int x, int y) {
  const auto here = point_at(frame, x, y);
  const auto left = point_at(frame, x - kReach, y), right = point_at(frame, x + kReach, y);
  const auto above = point_at(frame, x, y - kReach), below = point_at(frame, x, y + kReach);
  if (!here || !left || !right || !above || !below) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d normal = (*below - *above).cross(*right - *left).normalized();
  const Eigen::Vector3d middle = (*left + *right + *above + *below) / 4;
  // Depth noise grows with the square of the distance.
  const bool flat = std::abs(normal.dot(*here - middle)) < kFlatness * here->z() * here->z();
  return flat ? normal : Eigen::Vector3d::Zero();
}

}  // namespace

void HeightMap::Options::visit(stillpoint::OptionVisitor& v) {
  grid.visit(v);
  v("range", range, {.min = 0.5, .max = 20, .unit = "m", .help = "surfaces beyond are left out"});
  v("step", step, {.min = 1, .max = 64, .unit = "px", .help = "between pixels that are used"});
}

void HeightMap::integrate(const stillpoint::DenseKeyFrame& keyframe) {
  const stillpoint::Frame& frame = *keyframe.frame;
  const cv::Mat weights = keyframe.map_weights();
  const Eigen::Vector3d up_in_camera = keyframe.world_from_camera.linear().transpose() * kUp;
  View view{.world_from_camera = keyframe.world_from_camera};
  for (int y = 0; y < frame.depth.rows; y += options_.step)
    for (int x = 0; x < frame.depth.cols; x += options_.step) {
      const auto point = point_at(frame, x, y);
      if (!point || point->z() > options_.range) continue;
      if (!weights.empty() && weights.at<std::uint8_t>(y, x) < kMinWeight) continue;  // it moves
      view.points.push_back({.in_camera = point->cast<float>(),
                             .faces_up = normal_at(frame, x, y).dot(up_in_camera) > kMinCosine});
    }
  views_[keyframe.id] = std::move(view);
}

void HeightMap::move(std::span<const stillpoint::MovedKeyFrame> moved) {
  for (const stillpoint::MovedKeyFrame& keyframe : moved)
    if (const auto view = views_.find(keyframe.keyframe); view != views_.end())
      view->second.world_from_camera = keyframe.world_from_camera;
}

std::optional<HeightGrid> HeightMap::grid() const {
  std::vector<Eigen::Vector3f> points, ground;  // in world
  for (const auto& [id, view] : views_) {
    const Eigen::Isometry3f world_from_camera = view.world_from_camera.cast<float>();
    for (const Point& point : view.points) {
      points.push_back(world_from_camera * point.in_camera);
      if (point.faces_up) ground.push_back(points.back());
    }
  }
  const std::optional<Floor> floor = find_floor(ground, kUp.cast<float>());
  if (!floor) return std::nullopt;
  return make_grid(points, *floor, options_.grid);
}

void HeightMap::save(const std::filesystem::path& directory) {
  if (const std::optional<HeightGrid> map = grid())
    ::save(*map, options_.grid, directory);
  else
    log_(stillpoint::LogLevel::kWarning, "no floor is in view: there is no height map");
}

STILLPOINT_PLUGIN(height_map, "0.1.0",
                  stillpoint::provide<stillpoint::MapBackend, HeightMap>(
                      "height_map", "height above the floor per cell, for robots that drive"));
