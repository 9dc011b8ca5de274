#include "simulation/camera_motion.hpp"

#include <array>
#include <cmath>

#include "simulation/noise.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3d;

/// The camera at `eye` sees `target` in the middle of its image, with the horizon level.
Pose look_at(const Vector3d& eye, const Vector3d& target) {
  const Vector3d forward = (target - eye).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Pose world_from_camera = Pose::Identity();
  world_from_camera.linear() << right, forward.cross(right), forward;
  world_from_camera.translation() = eye;
  return world_from_camera;
}

/// Out and back, to both sides, at rest at both ends; `x` in periods, within [-1, 1].
double sway(double x) {
  const double window = std::sin(M_PI * x);
  return 1.3 * std::sin(2 * M_PI * x) * window * window;
}

/// One axis after the other, a period each.
Vector3d one_after_the_other(double periods) {
  Vector3d result = Vector3d::Zero();
  const auto turn = static_cast<Eigen::Index>(std::floor(periods));
  result[((turn % 3) + 3) % 3] = sway(periods - std::floor(periods));
  return result;
}

/// From the centre out to a circle, around it once, while its height goes up and down.
Vector3d room_loop(double turns) {
  const double angle = 2 * M_PI * turns + M_PI_2;
  return {1.25 * std::cos(angle), 1.25 * std::sin(angle), 0.12 * std::sin(2 * angle)};
}

}  // namespace

CameraMotion::CameraMotion(const MotionOptions& options, int seed)
    : options_(options), seed_(seed) {
  if (options.kind == MotionOptions::Kind::kWalk) path_.emplace(options.path);
}

Pose CameraMotion::world_from_camera(double time) const {
  const double t = time * options_.speed;
  return wanted(t) * trembling(t);
}

Pose CameraMotion::wanted(double t) const {
  const Vector3d eye(options_.position.data());
  const Vector3d target(options_.look_at.data());
  const double e = options_.extent;
  const Pose start = look_at(eye, target);
  switch (options_.kind) {
    case MotionOptions::Kind::kStatic:
      return start;
    case MotionOptions::Kind::kXyz: {
      const Vector3d shift = one_after_the_other(t / 5.2);
      // The height changes most, as in fr3_walking_xyz; the view follows a little.
      return Eigen::Translation3d(e * Vector3d(0.42, 0.36, 0.46).cwiseProduct(shift)) * start;
    }
    case MotionOptions::Kind::kRpy: {
      const Vector3d angle =
          e * Vector3d(0.42, 0.32, 0.44).cwiseProduct(one_after_the_other(t / 4.2));
      // Camera axes: z forward (roll), x right (pitch), y down (yaw).
      return start * Pose(Eigen::AngleAxisd(angle.z(), Vector3d::UnitY()) *
                          Eigen::AngleAxisd(angle.y(), Vector3d::UnitX()) *
                          Eigen::AngleAxisd(angle.x(), Vector3d::UnitZ()));
    }
    case MotionOptions::Kind::kHalfsphere: {
      const double azimuth = e * 0.50 * std::sin(2 * M_PI * t / 13.0);
      const double elevation = e * 0.27 * std::sin(2 * M_PI * t / 8.3 + 0.4);
      const Vector3d offset = eye - target;
      const Vector3d side = Vector3d::UnitZ().cross(offset).normalized();
      return look_at(target + Eigen::AngleAxisd(azimuth, Vector3d::UnitZ()) *
                                  (Eigen::AngleAxisd(-elevation, side) * offset),
                     target);
    }
    case MotionOptions::Kind::kLoop: {
      const double turns = t / 32.0;
      const Vector3d place = eye + e * room_loop(turns);
      const double angle = 2 * M_PI * turns + M_PI_2 + 0.25;
      return look_at(place, place + Vector3d(std::cos(angle), std::sin(angle), -0.2));
    }
    case MotionOptions::Kind::kWalk: {
      constexpr double kSpeed = 0.9;  // m/s
      constexpr double kAhead = 0.5;  // metres; one looks where one will go
      const double way = kSpeed * t;
      const Eigen::Vector2d foot = path_->at(way);
      const double angle = path_->heading(way + kAhead);
      const Vector3d place(foot.x(), foot.y(), eye.z());
      return look_at(place, place + Vector3d(std::cos(angle), std::sin(angle), -0.15));
    }
  }
  return start;
}

Pose CameraMotion::trembling(double t) const {
  // Breathing and sway are slow and large, the trembling of muscles is fast and small.
  struct Band {
    double frequency;    // Hz
    double translation;  // m
    double rotation;     // rad
  };
  constexpr std::array<Band, 5> kBands = {{{0.23, 0.0050, 0.0080},
                                           {0.61, 0.0022, 0.0080},
                                           {1.30, 0.0010, 0.0048},
                                           {2.70, 0.0004, 0.0018},
                                           {6.10, 0.0001, 0.0004}}};
  Vector6d twist = Vector6d::Zero();
  for (int axis = 0; axis < 6; ++axis) {
    for (std::size_t i = 0; i < kBands.size(); ++i) {
      const RowNoise random(static_cast<std::uint32_t>(seed_), 0, Stream::kColor,
                            -1 - axis - 6 * static_cast<int>(i));
      const double frequency = kBands[i].frequency * (0.8 + 0.4 * random.uniform(0));
      const double size = axis < 3 ? kBands[i].translation : kBands[i].rotation;
      twist[axis] +=
          options_.jitter * size * std::sin(2 * M_PI * (frequency * t + random.uniform(1)));
    }
  }
  return exp_se3(twist);
}

}  // namespace stillpoint::simulation
