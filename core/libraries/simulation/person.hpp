// People made of smooth rigid parts: they walk with feet on the floor, or sit and gesture.
#pragma once

#include <array>

#include "simulation/scene_options.hpp"
#include "simulation/world.hpp"

namespace stillpoint::simulation {

enum PersonPart {
  kPelvis,
  kTorso,
  kHead,
  kLeftThigh,
  kLeftShin,
  kLeftFoot,
  kRightThigh,
  kRightShin,
  kRightFoot,
  kLeftUpperArm,
  kLeftForearm,
  kRightUpperArm,
  kRightForearm,
  kCarriedBox,
  kPersonParts
};

/// Poses of a person's parts, world_from_part. Limbs point from their joint along -z.
using PersonPose = std::array<Eigen::Affine3d, kPersonParts>;

/// The motion of one person. `time` in seconds from the first frame.
std::function<PersonPose(double time)> person_motion(const PersonOptions& options);

void add_person(World& world, const PersonOptions& options);

}  // namespace stillpoint::simulation
