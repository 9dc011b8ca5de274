// A room with a pillar, seen by a camera: exact depth, a colour and a class per surface.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "stillpoint/contracts/map_backend.hpp"

namespace stillpoint::semantic_octree {

struct RoomSurface {
  std::uint8_t label = 0;
  cv::Vec3b bgr;
};
inline const RoomSurface kWall{0, {200, 180, 160}}, kFloor{0, {60, 70, 80}},
    kPillar{9, {30, 40, 210}};

inline Pose looking(const Eigen::Vector3d& from, double heading) {
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  pose.translation() = from;
  return pose;
}

/// World: z up, floor at 0.02, walls at ±1.93 and ±2.41 m, ceiling at 2.57 m; a pillar of 0.3 m
/// radius stands at (0.52, 1.03) when `pillar` is set.
class TestRoom {
 public:
  bool pillar = true;

  /// Distance along a ray from inside, in lengths of it, and what is there.
  std::pair<double, RoomSurface> hit(const Eigen::Vector3d& from,
                                     const Eigen::Vector3d& ray) const {
    double best = std::numeric_limits<double>::max();
    RoomSurface surface = kWall;
    const Eigen::Vector3d low(-1.93, -2.41, 0.02), high(1.93, 2.41, 2.57);
    for (int axis = 0; axis < 3; ++axis) {
      if (ray[axis] == 0) continue;
      const double t = ((ray[axis] > 0 ? high : low)[axis] - from[axis]) / ray[axis];
      if (t >= best) continue;
      best = t;
      surface = axis == 2 && ray[axis] < 0 ? kFloor : kWall;
    }
    if (pillar) {
      const Eigen::Vector2d to = from.head<2>() - Eigen::Vector2d(0.52, 1.03), d = ray.head<2>();
      const double a = d.squaredNorm(), b = to.dot(d), c = to.squaredNorm() - 0.09;
      const double root = b * b - a * c;
      const double t = root > 0 ? (-b - std::sqrt(root)) / a : -1;
      if (t > 0 && t < best) return {t, kPillar};
    }
    return {best, surface};
  }

  DenseKeyFrame render(const Pose& world_from_camera, KeyFrameId id = 0) const {
    auto frame = std::make_shared<Frame>();
    auto segmentation = std::make_shared<Segmentation>();
    frame->index = id;
    frame->camera = camera_;
    frame->depth.create(camera_->height, camera_->width, CV_32FC1);
    frame->bgr.create(frame->depth.size(), CV_8UC3);
    segmentation->labels.create(frame->depth.size(), CV_8UC1);
    for (int v = 0; v < camera_->height; ++v)
      for (int u = 0; u < camera_->width; ++u) {
        const Eigen::Vector3d ray = world_from_camera.linear() * camera_->unproject(u, v, 1.0);
        const auto [z, surface] = hit(world_from_camera.translation(), ray);
        frame->depth.at<float>(v, u) = static_cast<float>(z);
        frame->bgr.at<cv::Vec3b>(v, u) = surface.bgr;
        segmentation->labels.at<std::uint8_t>(v, u) = surface.label;
      }
    return {.id = id,
            .frame = std::move(frame),
            .segmentation = std::move(segmentation),
            .weights = std::make_shared<StaticWeights>(),
            .world_from_camera = world_from_camera};
  }

 private:
  static std::shared_ptr<const Camera> make_camera() {
    auto camera = std::make_shared<Camera>();
    camera->width = 320;
    camera->height = 240;
    camera->fx = camera->fy = 262.5;
    camera->cx = 159.5;
    camera->cy = 119.5;
    return camera;
  }
  std::shared_ptr<const Camera> camera_ = make_camera();
};

}  // namespace stillpoint::semantic_octree
