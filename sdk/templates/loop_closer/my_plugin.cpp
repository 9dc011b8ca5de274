#include "my_plugin.hpp"

#include <algorithm>
#include <stillpoint/support/rigid_motion.hpp>
#include <vector>

namespace plugins::my_plugin {
namespace {

using stillpoint::KeyFrame;
using stillpoint::Pose;

constexpr int kMaxDistance = 64;       // bits, of descriptors of one place
constexpr double kMaxRatio = 0.8;      // of the best distance to the second best
constexpr double kPixelNoise = 1.5;    // px
constexpr double kMinAgreement = 0.3;  // of the matches
constexpr int kSamples = 200;

bool usable(const KeyFrame& keyframe, std::size_t i) {
  return keyframe.features->depth[i] > 0 && keyframe.map_weights[i] > 0;
}

Eigen::Vector3d point_of(const KeyFrame& keyframe, std::size_t i) {
  const cv::Point2f& at = keyframe.features->keypoints[i].pt;
  return keyframe.camera->unproject(at.x, at.y, keyframe.features->depth[i]);
}

/// From features of the newest key frame to those of the old one.
std::vector<stillpoint::RigidMatch> matches_of(const KeyFrame& old, const KeyFrame& latest) {
  std::vector<stillpoint::RigidMatch> matches;
  for (std::size_t i = 0; i < latest.features->size(); ++i) {
    if (!usable(latest, i)) continue;
    int best = 256, second = 256;
    std::size_t of_old = 0;
    for (std::size_t k = 0; k < old.features->size(); ++k) {
      if (!usable(old, k)) continue;
      const int distance = stillpoint::hamming_distance(latest.features->descriptors[i],
                                                        old.features->descriptors[k]);
      if (distance < best) {
        second = best;
        best = distance;
        of_old = k;
      } else if (distance < second) {
        second = distance;
      }
    }
    if (best > kMaxDistance || best > kMaxRatio * second) continue;
    const cv::Point2f& pixel = old.features->keypoints[of_old].pt;
    matches.push_back({point_of(latest, i), point_of(old, of_old), {pixel.x, pixel.y}});
  }
  return matches;
}

}  // namespace

void MyPlugin::Options::visit(stillpoint::OptionVisitor& v) {
  v("min_gap", min_gap, {.min = 2, .unit = "key frames", .help = "between two ends of a loop"});
  v("radius", radius, {.min = 0, .unit = "m", .help = "in which old key frames are looked for"});
  v("max_angle", max_angle,
    {.min = 0, .max = 180, .unit = "degrees", .help = "between their directions of view"});
  v("min_inliers", min_inliers, {.min = 10, .help = "matches that agree on a rigid motion"});
  v("min_drift", min_drift, {.min = 0, .unit = "m", .help = "smaller ones are not corrected"});
}

std::optional<stillpoint::MapCorrection> MyPlugin::close(const stillpoint::SparseMap& map,
                                                         stillpoint::KeyFrameId latest_id,
                                                         std::stop_token stop) {
  const KeyFrame* latest = map.keyframe(latest_id);
  if (!latest || latest->features->descriptors.empty()) return std::nullopt;
  const KeyFrame* old = candidate(map, *latest);
  if (!old) return std::nullopt;
  const auto relative = old_from_latest(*old, *latest);
  if (!relative || stop.stop_requested()) return std::nullopt;
  const Pose corrected_from_world =
      old->world_from_camera * *relative * latest->world_from_camera.inverse();
  const Pose moved_latest = corrected_from_world * latest->world_from_camera;
  if ((moved_latest.translation() - latest->world_from_camera.translation()).norm() <
      options_.min_drift)
    return std::nullopt;

  // In place of a pose graph: each key frame in between takes its share. Landmarks move with their
  // key frames, and key frames that are newer than this map with their parents.
  stillpoint::MapCorrection correction{
      .keyframe_id_end = static_cast<stillpoint::KeyFrameId>(map.keyframe_id_end())};
  const double length = latest_id - old->id;
  for (stillpoint::KeyFrameId id = old->id + 1; id < map.keyframe_id_end(); ++id) {
    const KeyFrame* keyframe = map.keyframe(id);
    if (!keyframe) continue;
    const double share = std::min(1.0, (id - old->id) / length);
    const Pose shift = stillpoint::interpolate(Pose::Identity(), corrected_from_world, share);
    correction.moved.push_back(
        {id, stillpoint::orthonormalised(shift * keyframe->world_from_camera)});
  }
  return correction;
}

/// The nearest old key frame that looks the same way and shares no landmarks with the newest: those
/// that do, tracking has found already.
const KeyFrame* MyPlugin::candidate(const stillpoint::SparseMap& map,
                                    const KeyFrame& latest) const {
  const KeyFrame* best = nullptr;
  double nearest = options_.radius;
  for (stillpoint::KeyFrameId id = 0; id + static_cast<unsigned>(options_.min_gap) <= latest.id;
       ++id) {
    const KeyFrame* keyframe = map.keyframe(id);
    if (!keyframe || keyframe->features->descriptors.empty()) continue;
    if (std::ranges::find(latest.covisible, id, &stillpoint::Covisibility::keyframe) !=
        latest.covisible.end())
      continue;
    const Pose between = keyframe->world_from_camera.inverse() * latest.world_from_camera;
    if (between.translation().norm() > nearest ||
        stillpoint::rotation_angle(between) > options_.max_angle * EIGEN_PI / 180)
      continue;
    nearest = between.translation().norm();
    best = keyframe;
  }
  return best;
}

std::optional<Pose> MyPlugin::old_from_latest(const KeyFrame& old, const KeyFrame& latest) const {
  const std::vector<stillpoint::RigidMatch> matches = matches_of(old, latest);
  const auto motion = stillpoint::find_rigid_motion(
      matches, *old.camera, {.pixel = kPixelNoise, .inverse_depth = old.camera->depth_noise}, {},
      kSamples, seed_);
  if (!motion || motion->inliers < options_.min_inliers || motion->agreement < kMinAgreement)
    return std::nullopt;
  return motion->target_from_source;
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::LoopCloser, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "matches nearby key frames and distributes the drift linearly"));
