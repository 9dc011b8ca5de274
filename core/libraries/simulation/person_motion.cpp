#include <algorithm>
#include <cmath>
#include <memory>

#include "simulation/person.hpp"
#include "simulation/walking_path.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Affine3d;
using Eigen::AngleAxisd;
using Eigen::Translation3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

/// Angles in radians. Person frame: x ahead, y left, z up. Positive flexion swings a limb ahead.
struct Joints {
  Vector3d pelvis = {0, 0, 0};  ///< metres, over the point on the floor
  double lean = 0;              ///< of the torso, ahead
  double twist = 0;             ///< of the torso, to the left
  double head_yaw = 0;
  double head_pitch = 0;
  std::array<double, 2> hip = {};  ///< left, right
  std::array<double, 2> knee = {};
  std::array<double, 2> foot = {};  ///< toes up
  std::array<double, 2> shoulder = {};
  std::array<double, 2> elbow = {};
  std::array<double, 2> arm_out = {};
};

Affine3d flexion(double angle) { return Affine3d(AngleAxisd(-angle, Vector3d::UnitY())); }

/// Body proportions after Drillis and Contini (1966), as shares of the height.
PersonPose assemble(const Joints& joints, const Affine3d& world_from_person, double height) {
  PersonPose pose;
  const Affine3d pelvis = world_from_person * Translation3d(joints.pelvis);
  pose[kPelvis] = pelvis;
  pose[kTorso] = pelvis * Translation3d(0, 0, 0.03 * height) * flexion(-joints.lean) *
                 AngleAxisd(joints.twist, Vector3d::UnitZ());
  pose[kHead] = pose[kTorso] * Translation3d(0.01 * height, 0, 0.29 * height) *
                AngleAxisd(joints.head_yaw, Vector3d::UnitZ()) * flexion(-joints.head_pitch);
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1 : -1;
    const std::size_t leg = side == 0 ? kLeftThigh : kRightThigh;
    pose[leg] = pelvis * Translation3d(0, sign * 0.052 * height, 0) * flexion(joints.hip[side]);
    pose[leg + 1] = pose[leg] * Translation3d(0, 0, -0.245 * height) * flexion(-joints.knee[side]);
    pose[leg + 2] = pose[leg + 1] * Translation3d(0, 0, -0.246 * height) *
                    flexion(joints.knee[side] - joints.hip[side] + joints.foot[side]);
    const std::size_t arm = side == 0 ? kLeftUpperArm : kRightUpperArm;
    pose[arm] = pose[kTorso] * Translation3d(0, sign * 0.118 * height, 0.255 * height) *
                AngleAxisd(sign * joints.arm_out[side], Vector3d::UnitX()) *
                flexion(joints.shoulder[side]);
    pose[arm + 1] = pose[arm] * Translation3d(0, 0, -0.172 * height) * flexion(joints.elbow[side]);
  }
  pose[kCarriedBox] = world_from_person * Translation3d(0.20 * height, 0, 0.63 * height);
  return pose;
}

/// Moves the pelvis so that the lower foot stands on the floor.
void stand_on_floor(Joints& joints, double height) {
  constexpr double kAnkle = 0.045;  // of the height, ankle above the floor
  double reach = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    reach = std::max(reach, 0.245 * std::cos(joints.hip[side]) +
                                0.246 * std::cos(joints.hip[side] - joints.knee[side]));
  }
  joints.pelvis.z() = (reach + kAnkle) * height;
}

Joints walking(double phase, double height, bool carries_box) {
  Joints joints;
  for (std::size_t side = 0; side < 2; ++side) {
    const double p = phase + (side == 0 ? 0 : M_PI);
    const double swing = std::max(0.0, std::cos(p));  // the leg moves ahead while sin(p) grows
    joints.hip[side] = (4 + 23 * std::sin(p)) * kDegree + 12 * kDegree * swing * swing;
    joints.knee[side] = (6 + 52 * swing * swing) * kDegree;
    joints.foot[side] = (10 * std::sin(p) - 22 * std::max(0.0, -std::sin(p)) * swing) * kDegree;
    joints.shoulder[side] = (carries_box ? 38 : -24 * std::sin(p)) * kDegree;
    joints.elbow[side] = (carries_box ? 62 : 22 - 10 * std::sin(p)) * kDegree;
    joints.arm_out[side] = (carries_box ? 4 : 8) * kDegree;
  }
  joints.lean = 4 * kDegree;
  joints.twist = 6 * kDegree * std::sin(phase);
  joints.head_yaw = -5 * kDegree * std::sin(phase) + 12 * kDegree * std::sin(0.21 * phase);
  stand_on_floor(joints, height);
  return joints;
}

Joints sitting(double time, double rhythm) {
  constexpr double kSeat = 0.55;  // metres, pelvis above the floor
  const auto wave = [&](double frequency, double shift) {
    return std::sin(2 * M_PI * frequency * time + rhythm + shift);
  };
  Joints joints;
  joints.pelvis = {0, 0, kSeat};
  joints.lean = (9 + 4 * wave(0.11, 0) + 1.5 * wave(0.37, 1)) * kDegree;
  joints.twist = (5 * wave(0.13, 2) + 2 * wave(0.41, 0)) * kDegree;
  joints.head_yaw = (18 * wave(0.09, 1) + 6 * wave(0.31, 3)) * kDegree;
  joints.head_pitch = (6 + 5 * wave(0.23, 2)) * kDegree;
  joints.hip = {84 * kDegree, 80 * kDegree};
  joints.knee = {80 * kDegree, 88 * kDegree};
  // One hand explains something now and then, the other rests.
  const double talk = std::max(0.0, wave(0.07, 0));
  joints.shoulder = {(24 + 20 * talk + 5 * talk * wave(0.9, 0)) * kDegree,
                     (26 + 4 * wave(0.17, 1)) * kDegree};
  joints.elbow = {(62 + 28 * talk * wave(0.7, 1)) * kDegree, (58 + 6 * wave(0.19, 0)) * kDegree};
  joints.arm_out = {(12 + 10 * talk) * kDegree, 10 * kDegree};
  return joints;
}

Affine3d standing_at(const Eigen::Vector2d& place, double heading) {
  return Translation3d(place.x(), place.y(), 0) * AngleAxisd(heading, Vector3d::UnitZ());
}

}  // namespace

std::function<PersonPose(double time)> person_motion(const PersonOptions& options) {
  const double rhythm = 1.7 * options.seed;
  if (options.pose == PersonOptions::Pose::kSit) {
    const Affine3d seat =
        standing_at({options.path[0], options.path[1]}, options.heading * kDegree);
    return [=](double time) { return assemble(sitting(time, rhythm), seat, options.height); };
  }
  const auto path = std::make_shared<const WalkingPath>(options.path);
  return [=](double time) {
    constexpr double kSpeedVariation = 0.5;        // share by which the speed varies
    constexpr double kFrequency = 2 * M_PI / 7.0;  // of that variation, rad/s
    const double way =
        options.start +
        options.speed * (time - kSpeedVariation / kFrequency *
                                    (std::cos(kFrequency * time + rhythm) - std::cos(rhythm)));
    const double stride = 0.74 * options.height;  // metres, two steps
    const double phase = 2 * M_PI * way / stride;
    return assemble(walking(phase, options.height, options.carries_box),
                    standing_at(path->at(way), path->heading(way)), options.height);
  };
}

}  // namespace stillpoint::simulation
