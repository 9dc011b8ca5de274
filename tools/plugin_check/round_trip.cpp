#include "plugin_check/round_trip.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace stillpoint::plugin_check {
namespace {

constexpr int kPoints = 6000;                                  // some 500 of them in a view
const Eigen::Vector3d kLowest(-6, -2, -7), kHighest(6, 2, 5);  // metres
const Eigen::Vector3d kCentre(0, 0, -1);                       // of the circle
constexpr double kDrift = 0.004;       // per key frame: 17 cm and 5 degrees after one turn
constexpr double kPixelNoise = 0.3;    // px on level 0
constexpr double kDepthNoise = 0.002;  // of the inverse depth, 1/m
constexpr int kFlippedBits = 10;       // of each descriptor
constexpr double kNearest = 0.3, kFarthestDepth = 8.0;  // metres
constexpr double kBorder = 19;                          // px
constexpr float kFeatureSize = 31;                      // px, of ORB
constexpr double kSecondsPerKeyFrame = 0.3;

/// On a circle of 1 m around kCentre, looking outwards; the first is at the origin.
Pose true_pose(int keyframe) {
  const double angle = 2 * std::numbers::pi * keyframe / RoundTrip::kPerTurn;
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3({0, angle, 0});
  pose.translation() =
      Eigen::Vector3d(std::sin(angle), 0.05 * std::sin(3 * angle), std::cos(angle) - 1);
  return pose;
}

Pose drifted_pose(int keyframe) {
  Vector6d twist;
  twist << 1, -0.3, 0.5, 0.1, 0.6, -0.2;
  return true_pose(keyframe) * exp_se3(kDrift * keyframe * twist);
}

Pose step_to(int keyframe) { return drifted_pose(keyframe - 1).inverse() * drifted_pose(keyframe); }

}  // namespace

RoundTrip::RoundTrip() {
  for (int i = 0; i < kPoints; ++i) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = uniform(kLowest[axis], kHighest[axis]);
    const double level = uniform(0, 5);
    points_.push_back(
        {.in_world = point,
         .descriptor = random_descriptor(),
         .angle = uniform(0, 360),
         .max_distance = (point - kCentre).norm() * std::pow(Features().scale_factor, level)});
  }
}

SparseMap RoundTrip::with_next(SparseMap map) {
  const int now = next_++;
  const auto id = static_cast<KeyFrameId>(map.keyframe_id_end());
  std::vector<Point*> seen;
  KeyFrame keyframe = view(now, seen);
  keyframe.id = id;
  keyframe.frame = static_cast<std::uint32_t>(now);
  keyframe.time = now * kSecondsPerKeyFrame;
  keyframe.world_from_camera =
      now == 0 ? true_pose(0) : orthonormalised(map.world_from_keyframe(id - 1) * step_to(now));

  const Pose camera_from_world = true_pose(now).inverse();
  MapEdit edit(std::move(map));
  edit.add_keyframe(keyframe);
  for (std::uint32_t i = 0; i < seen.size(); ++i) {
    Point& point = *seen[i];
    point.landmark = edit.map().current_id(point.landmark);  // a closed loop may have fused it
    if (point.landmark == kNoId || now - point.last_seen > kPerTurn / 2)
      point.landmark =
          edit.add_landmark(landmark_of(keyframe, i, camera_from_world * point.in_world));
    point.last_seen = now;
    edit.add_observation(point.landmark, {id, i});
  }
  edit.update_covisibility(id);
  return std::move(edit).finish();
}

KeyFrame RoundTrip::view(int now, std::vector<Point*>& seen) {
  const Pose camera_from_world = true_pose(now).inverse();
  const Eigen::Vector3d x_axis = camera_from_world.linear().col(0);
  const double turn = std::atan2(x_axis.y(), x_axis.x()) * 180 / std::numbers::pi;
  auto features = std::make_shared<Features>();
  for (Point& point : points_) {
    const Eigen::Vector3d p = camera_from_world * point.in_world;
    if (p.z() < kNearest) continue;
    const int level = static_cast<int>(
        std::lround(std::log(point.max_distance / p.norm()) / std::log(features->scale_factor)));
    if (level < 0 || level >= features->levels) continue;
    const double sigma = kPixelNoise * std::pow(features->scale_factor, level);
    const Eigen::Vector2d pixel = camera_->project(p) + sigma * Eigen::Vector2d(normal(), normal());
    if (!camera_->contains(pixel.x(), pixel.y(), kBorder)) continue;
    cv::KeyPoint keypoint(cv::Point2f(static_cast<float>(pixel.x()), static_cast<float>(pixel.y())),
                          kFeatureSize);
    keypoint.octave = level;
    keypoint.angle = static_cast<float>(std::fmod(point.angle + turn + 360, 360));
    const double depth = 1 / (1 / p.z() + kDepthNoise * normal());
    features->keypoints.push_back(keypoint);
    features->descriptors.push_back(seen_as(point.descriptor));
    features->depth.push_back(p.z() > kFarthestDepth ? 0.0F : static_cast<float>(depth));
    seen.push_back(&point);
  }
  KeyFrame keyframe;
  keyframe.camera = camera_;
  keyframe.track_weights.assign(features->size(), 255);
  keyframe.map_weights = keyframe.track_weights;
  keyframe.landmarks.assign(features->size(), kNoId);
  keyframe.features = std::move(features);
  return keyframe;
}

Descriptor RoundTrip::seen_as(Descriptor descriptor) {
  for (int i = 0; i < kFlippedBits; ++i) {
    const std::uint64_t bit = random_() % 256;
    descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return descriptor;
}

Landmark RoundTrip::landmark_of(const KeyFrame& keyframe, std::uint32_t feature,
                                const Eigen::Vector3d& in_camera) const {
  const Features& features = *keyframe.features;
  const Eigen::Vector3d view = keyframe.world_from_camera.linear() * in_camera;
  const double farthest =
      in_camera.norm() * std::pow(features.scale_factor, features.keypoints[feature].octave);
  Landmark landmark;
  landmark.position_in_world = keyframe.world_from_camera.translation() + view;
  landmark.mean_view = view.normalized();
  landmark.max_distance = static_cast<float>(farthest);
  landmark.min_distance =
      static_cast<float>(farthest / std::pow(features.scale_factor, features.levels - 1));
  landmark.descriptor = features.descriptors[feature];
  landmark.created_by = keyframe.id;
  return landmark;
}

double RoundTrip::error(const SparseMap& map) const {
  const auto newest = static_cast<KeyFrameId>(map.keyframe_id_end() - 1);
  const Pose first_from_newest =
      map.world_from_keyframe(0).inverse() * map.world_from_keyframe(newest);
  return (first_from_newest.translation() - true_pose(next_ - 1).translation()).norm();
}

}  // namespace stillpoint::plugin_check
