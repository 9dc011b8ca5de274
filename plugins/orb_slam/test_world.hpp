// A synthetic world with known truth, for tests: points with descriptors of their own, seen by a
// camera with noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/observed_frame.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

struct WorldPoint {
  Eigen::Vector3d position;  // metres
  Descriptor descriptor{};
  double angle = 0.0;         // degrees, of its texture against the x axis of the world
  double max_distance = 0.0;  // metres, from which it appears on pyramid level 0
};

struct Noise {
  double pixel = 0.3;            // px on level 0, standard deviation
  double inverse_depth = 0.002;  // 1/m, standard deviation
  int flipped_bits = 10;         // of each descriptor
  double max_depth = 8.0;        // metres; farther, no depth is measured
};
inline constexpr Noise kNoNoise{.pixel = 0, .inverse_depth = 0, .flipped_bits = 0};
inline constexpr Noise kNoDepth{.max_depth = 0};

// What a camera sees of the world; `point` is the truth of each feature.
struct View {
  Pose world_from_camera = Pose::Identity();
  std::shared_ptr<const Camera> camera;
  FeaturesPtr features;
  std::vector<std::uint32_t> point;
};

struct Box {
  Eigen::Vector3d low{-5, -3, 2}, high{5, 3, 7};
};

class TestWorld {
 public:
  explicit TestWorld(int points = 1500, std::uint64_t seed = 1, const Box& box = {})
      : random_(seed) {
    for (int i = 0; i < points; ++i) {
      Eigen::Vector3d p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = uniform(box.low[axis], box.high[axis]);
      const double level = uniform(0.5, 5.5);  // from the middle of the box's front
      const Eigen::Vector3d eye(0.5 * (box.low.x() + box.high.x()), 0, box.low.z() - 2);
      points_.push_back(
          {p, descriptor(), uniform(0, 360), (p - eye).norm() * std::pow(kScaleFactor, level)});
    }
  }

  View render(const Pose& world_from_camera, const Noise& noise = {}) {
    View view{world_from_camera, camera_};
    const Pose camera_from_world = world_from_camera.inverse();
    const Eigen::Vector3d x_axis = camera_from_world.linear().col(0);
    const double turn = std::atan2(x_axis.y(), x_axis.x()) * 180.0 / M_PI;
    auto features = std::make_shared<Features>();
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d p = camera_from_world * points_[i].position;
      if (p.z() < 0.3) continue;
      const int level = level_at(points_[i], p.norm());
      const double sigma = noise.pixel * std::pow(kScaleFactor, level);
      const Eigen::Vector2d pixel =
          camera_->project(p) + sigma * Eigen::Vector2d(normal(), normal());
      const double depth = 1.0 / (1.0 / p.z() + noise.inverse_depth * normal());
      if (level < 0 || level >= features->levels || !camera_->contains(pixel.x(), pixel.y(), 19))
        continue;
      cv::KeyPoint keypoint(
          cv::Point2f(static_cast<float>(pixel.x()), static_cast<float>(pixel.y())), 31.0f);
      keypoint.octave = level;
      keypoint.angle = static_cast<float>(std::fmod(points_[i].angle + turn + 360.0, 360.0));
      features->keypoints.push_back(keypoint);
      features->descriptors.push_back(flipped(points_[i].descriptor, noise.flipped_bits));
      features->depth.push_back(p.z() > noise.max_depth ? 0.0f : static_cast<float>(depth));
      view.point.push_back(i);
    }
    view.features = std::move(features);
    return view;
  }

  const std::vector<WorldPoint>& points() const { return points_; }
  const std::shared_ptr<const Camera>& camera() const { return camera_; }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  Descriptor descriptor() { return {random_(), random_(), random_(), random_()}; }
  Descriptor flipped(Descriptor d, int bits) {
    for (int i = 0; i < bits; ++i) {
      const std::uint64_t bit = random_() % 256;
      d[bit / 64] ^= std::uint64_t{1} << (bit % 64);
    }
    return d;
  }

 private:
  static constexpr double kScaleFactor = 1.2;

  static int level_at(const WorldPoint& point, double distance) {
    return static_cast<int>(
        std::lround(std::log(point.max_distance / distance) / std::log(kScaleFactor)));
  }

  std::mt19937_64 random_;
  std::vector<WorldPoint> points_;
  std::shared_ptr<const Camera> camera_ = std::make_shared<Camera>();
};

inline Pose pose_at(const Eigen::Vector3d& position,
                    const Eigen::Vector3d& rotation = Eigen::Vector3d::Zero()) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(rotation);
  pose.translation() = position;
  return pose;
}

inline double metres_between(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm();
}
inline double radians_between(const Pose& a, const Pose& b) {
  return rotation_angle(a.inverse() * b);
}

// A camera that goes to the right, up and down, and looks around a little; it begins at the origin.
inline Pose walk(int step) {
  const double s = 0.1 * step;
  return pose_at({s, 0.1 * std::sin(2 * s), 0.2 * s}, {0.03 * std::sin(s), -0.1 * s, 0.05 * s});
}

inline KeyFrame keyframe_of(const View& view, KeyFrameId id) {
  const std::size_t count = view.features->size();
  return {.id = id,
          .frame = id,
          .time = 0.1 * id,
          .world_from_camera = view.world_from_camera,
          .camera = view.camera,
          .features = view.features,
          .track_weights = std::vector<std::uint8_t>(count, 255),
          .map_weights = std::vector<std::uint8_t>(count, 255),
          .landmarks = std::vector<LandmarkId>(count, kNoId)};
}

// A map of views at their true places, with every point they see as a landmark at its true place.
struct KnownMap {
  SparseMap map;
  std::vector<std::uint32_t> point;     // per landmark
  std::vector<LandmarkId> landmark_of;  // per point; kNoId = not seen
};

inline KnownMap known_map(const TestWorld& world, const std::vector<View>& views) {
  KnownMap known{.landmark_of = std::vector<LandmarkId>(world.points().size(), kNoId)};
  MapEdit edit{SparseMap{}};
  for (KeyFrameId id = 0; id < views.size(); ++id) {
    edit.add_keyframe(keyframe_of(views[id], id));
    for (std::uint32_t i = 0; i < views[id].point.size(); ++i) {
      const std::uint32_t point = views[id].point[i];
      LandmarkId& landmark = known.landmark_of[point];
      if (landmark == kNoId) {
        landmark = edit.add_landmark(
            {.position_in_world = world.points()[point].position, .created_by = id});
        known.point.push_back(point);
      }
      edit.add_observation(landmark, {id, i});
    }
  }
  for (LandmarkId id = 0; id < known.point.size(); ++id) refresh_landmark(edit, id);
  for (KeyFrameId id = 0; id < views.size(); ++id) edit.update_covisibility(id);
  known.map = std::move(edit).finish();
  return known;
}

// The view as tracking sees it: no landmark yet, no idea of the pose.
inline ObservedFrame observed(const View& view) {
  const std::size_t count = view.features->size();
  auto frame = std::make_shared<Frame>();
  frame->camera = view.camera;
  ObservedFrame result;
  result.frame = std::move(frame);
  result.features = view.features;
  result.grid = FeatureGrid(*view.features, *view.camera);
  result.track_weights.assign(count, 255);
  result.map_weights.assign(count, 255);
  result.landmarks.assign(count, kNoId);
  result.temporary.resize(count);
  result.outlier.assign(count, false);
  return result;
}

}  // namespace stillpoint::orb_slam
