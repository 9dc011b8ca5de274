#include "orb_slam/landmark_creation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/matcher.hpp"
#include "orb_slam/pose_solver.hpp"
#include "stillpoint/support/median.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr double kMinBaselineShare = 0.01;  // of the median depth; less gives no parallax
constexpr double kMinParallax = 10.0;       // standard deviations of a feature's direction
constexpr double kChiSquare1 = 3.84;        // 95 % bound with one measurement

bool wants_landmark(const KeyFrame& keyframe, std::uint32_t i) {
  return keyframe.landmarks[i] == kNoId && keyframe.map_weights[i] >= kMinMapWeight &&
         keyframe.track_weights[i] >= kMinMapWeight;
}

std::vector<std::uint32_t> features_without_landmark(const KeyFrame& keyframe) {
  std::vector<std::uint32_t> open;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i)
    if (wants_landmark(keyframe, i)) open.push_back(i);
  return open;
}

double median_depth(const KeyFrame& keyframe) {
  std::vector<float> depths;
  for (const float d : keyframe.features->depth)
    if (d > 0) depths.push_back(d);
  return median(std::move(depths));
}

LandmarkId add_observed_by(MapEdit& edit, const Eigen::Vector3d& position, KeyFrameId creator,
                           std::initializer_list<Observation> observations) {
  const LandmarkId id = edit.add_landmark({.position_in_world = position, .created_by = creator});
  for (const Observation& o : observations) edit.add_observation(id, o);
  refresh_landmark(edit, id);
  return id;
}

Eigen::Vector3d ray(const KeyFrame& keyframe, std::uint32_t feature) {
  const cv::Point2f p = keyframe.features->keypoints[feature].pt;
  return keyframe.camera->unproject(p.x, p.y, 1.0);
}

// Two views of the world, the first being the new key frame.
class ViewPair {
 public:
  ViewPair(const KeyFrame& a, const KeyFrame& b)
      : a_(a),
        b_(b),
        a_from_world_(a.world_from_camera.inverse()),
        b_from_world_(b.world_from_camera.inverse()),
        b_from_a_(b_from_world_ * a.world_from_camera),
        essential_(skew(b_from_a_.translation()) * b_from_a_.linear()),
        a_pyramid_(*a.features),
        b_pyramid_(*b.features) {}

  double baseline() const { return b_from_a_.translation().norm(); }

  /// Whether feature j of b lies on the epipolar line of feature i of a, within its noise.
  bool on_epipolar_line(const Eigen::Vector3d& line, std::uint32_t j) const {
    const Eigen::Vector3d x = ray(b_, j);
    const double distance = line.dot(x) / std::hypot(line.x(), line.y()) * b_.camera->fx;
    const double sigma = b_pyramid_.pixel_sigma(b_.features->keypoints[j].octave);
    return distance * distance <= kChiSquare1 * sigma * sigma;
  }
  Eigen::Vector3d epipolar_line(std::uint32_t i) const { return essential_ * ray(a_, i); }

  /// The point both features see; nothing when the rays are too nearly parallel, or the
  /// reprojection error is too large.
  std::optional<Eigen::Vector3d> intersect(std::uint32_t i, std::uint32_t j) const {
    const Eigen::Vector3d u = a_.world_from_camera.linear() * ray(a_, i).normalized();
    const Eigen::Vector3d v = b_.world_from_camera.linear() * ray(b_, j).normalized();
    const double cosine = u.dot(v);
    if (std::atan2(u.cross(v).norm(), cosine) < kMinParallax * direction_sigma(i, j))
      return std::nullopt;
    // Midpoint of the shortest segment between the rays.
    const Eigen::Vector3d w =
        b_.world_from_camera.translation() - a_.world_from_camera.translation();
    const double denominator = 1.0 - cosine * cosine;
    const double s = (w.dot(u) - cosine * w.dot(v)) / denominator;
    const double t = (cosine * w.dot(u) - w.dot(v)) / denominator;
    if (s <= 0 || t <= 0) return std::nullopt;
    const Eigen::Vector3d point = 0.5 * (a_.world_from_camera.translation() + s * u +
                                         b_.world_from_camera.translation() + t * v);
    if (!observation_error(point, a_from_world_, a_, i).fits() ||
        !observation_error(point, b_from_world_, b_, j).fits())
      return std::nullopt;
    return point;
  }

 private:
  /// Radians: of the coarser of two features.
  double direction_sigma(std::uint32_t i, std::uint32_t j) const {
    return std::max(a_pyramid_.pixel_sigma(a_.features->keypoints[i].octave) / a_.camera->fx,
                    b_pyramid_.pixel_sigma(b_.features->keypoints[j].octave) / b_.camera->fx);
  }

  const KeyFrame& a_;
  const KeyFrame& b_;
  Pose a_from_world_, b_from_world_, b_from_a_;
  Eigen::Matrix3d essential_;
  ScalePyramid a_pyramid_, b_pyramid_;
};

void triangulate_pair(MapEdit& edit, KeyFrameId a_id, KeyFrameId b_id,
                      std::vector<LandmarkId>& created) {
  const std::shared_ptr<const KeyFrame> a = edit.map().shared_keyframe(a_id);
  const std::shared_ptr<const KeyFrame> b = edit.map().shared_keyframe(b_id);
  const ViewPair views(*a, *b);
  if (views.baseline() < kMinBaselineShare * median_depth(*b)) return;
  const std::vector<std::uint32_t> open_a = features_without_landmark(*a),
                                   open_b = features_without_landmark(*b);
  std::vector<bool> used(b->features->size());
  for (const std::uint32_t i : open_a) {
    const Eigen::Vector3d line = views.epipolar_line(i);
    const int level = a->features->keypoints[i].octave;
    int best_distance = kStrictDistance + 1;
    std::uint32_t best = 0;
    for (const std::uint32_t j : open_b) {
      if (used[j] || std::abs(b->features->keypoints[j].octave - level) > 1) continue;
      if (!views.on_epipolar_line(line, j)) continue;
      const int distance =
          hamming_distance(a->features->descriptors[i], b->features->descriptors[j]);
      if (distance >= best_distance) continue;
      best_distance = distance;
      best = j;
    }
    if (best_distance > kStrictDistance) continue;
    const auto point = views.intersect(i, best);
    if (!point) continue;
    used[best] = true;
    created.push_back(add_observed_by(edit, *point, a_id, {{b_id, best}, {a_id, i}}));
  }
}

}  // namespace

std::vector<LandmarkId> create_from_depth(MapEdit& edit, KeyFrameId id) {
  const std::shared_ptr<const KeyFrame> keyframe = edit.map().shared_keyframe(id);
  std::vector<LandmarkId> created;
  for (const std::uint32_t i : features_without_landmark(*keyframe)) {
    const double depth = keyframe->features->depth[i];
    if (depth <= 0) continue;
    const Eigen::Vector3d point = keyframe->world_from_camera * (ray(*keyframe, i) * depth);
    created.push_back(add_observed_by(edit, point, id, {{id, i}}));
  }
  return created;
}

std::vector<LandmarkId> triangulate(MapEdit& edit, KeyFrameId id, int neighbours) {
  std::vector<LandmarkId> created;
  const std::vector<Covisibility> covisible = edit.map().keyframe(id)->covisible;
  for (std::size_t i = 0; i < covisible.size() && static_cast<int>(i) < neighbours; ++i)
    triangulate_pair(edit, id, covisible[i].keyframe, created);
  return created;
}

}  // namespace stillpoint::orb_slam
