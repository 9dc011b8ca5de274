#include "orb_slam/targets.hpp"

namespace stillpoint::orb_slam {
namespace {

Target target_of(const Features& features, std::uint32_t i, LandmarkId landmark,
                 const Eigen::Vector3d& point_in_world) {
  const cv::KeyPoint& k = features.keypoints[i];
  return {landmark, point_in_world, features.descriptors[i], k.octave, k.angle};
}

}  // namespace

std::vector<Target> targets_of(const KeyFrame& keyframe, const SparseMap& map) {
  std::vector<Target> targets;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i)
    if (const Landmark* landmark = map.landmark(keyframe.landmarks[i]))
      targets.push_back(
          target_of(*keyframe.features, i, landmark->id, landmark->position_in_world));
  return targets;
}

std::vector<Target> targets_of(const ObservedFrame& frame, const SparseMap& map) {
  std::vector<Target> targets;
  const Features& features = *frame.features;
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    if (const Landmark* landmark = map.landmark(frame.landmarks[i])) {
      targets.push_back(target_of(features, i, landmark->id, landmark->position_in_world));
    } else if (features.depth[i] > 0 && frame.track_weights[i] == 255) {
      const cv::Point2f p = features.keypoints[i].pt;
      const Eigen::Vector3d point = frame.frame->camera->unproject(p.x, p.y, features.depth[i]);
      targets.push_back(target_of(features, i, kNoId, frame.world_from_camera * point));
    }
  }
  return targets;
}

int match_projected(ObservedFrame& frame, std::span<const Target> targets,
                    const Pose& camera_from_world, double window, int levels) {
  const Camera& camera = *frame.frame->camera;
  const ScalePyramid pyramid(*frame.features);
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < targets.size(); ++i) {
    const Target& target = targets[i];
    const Eigen::Vector3d p = camera_from_world * target.point_in_world;
    if (p.z() <= 0) continue;
    const Eigen::Vector2d pixel = camera.project(p);
    if (!camera.contains(pixel.x(), pixel.y())) continue;
    queries.push_back({.id = i,
                       .descriptor = target.descriptor,
                       .u = pixel.x(),
                       .v = pixel.y(),
                       .radius = window * pyramid.scale(target.octave),
                       .min_level = target.octave - levels,
                       .max_level = target.octave + levels,
                       .angle = target.angle});
  }
  const std::vector<Match> matches =
      match_near(queries, *frame.features, frame.grid,
                 [&](std::uint32_t i) { return frame.usable(i); }, {.consistent_angles = true});
  assign_targets(frame, targets, matches);
  return static_cast<int>(matches.size());
}

void assign_targets(ObservedFrame& frame, std::span<const Target> targets,
                    std::span<const Match> matches) {
  frame.clear_matches();
  for (const Match& m : matches) {
    const Target& target = targets[m.id];
    if (target.landmark != kNoId)
      frame.landmarks[m.feature] = target.landmark;
    else
      frame.temporary[m.feature] = target.point_in_world;
  }
}

}  // namespace stillpoint::orb_slam
