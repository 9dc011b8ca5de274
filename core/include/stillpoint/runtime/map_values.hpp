// Which values cameras, features and maps can have. The same limits hold for what plugins give and
// for saved maps, which may be malicious and have correct checksums.
#pragma once

#include <string>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/landmark.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint {

/// Whether all values are finite and could be those of a camera.
bool possible(const Camera& camera);

/// Greatest norm of R Rᵀ - 1 of a pose that a plugin gives.
inline constexpr double kLargestSkew = 1e-3;

/// Whether a pose is a rigid motion, no scale and no mirror image, of up to 10,000 km.
bool is_rigid_motion(const Pose& pose);

/// Whether a position is finite and within 10,000 km.
bool is_near(const Eigen::Vector3d& position);

/// What is wrong with features of images of that camera; empty: nothing. Keypoints lie in the image
/// and in the pyramid, which has up to 64 levels and a factor of up to 4 between two; depths are
/// not negative.
std::string fault_of(const Features& features, const Camera& camera);

/// What is wrong with a landmark; empty: nothing.
std::string fault_of(const Landmark& landmark);

/// Each throws DamagedMap when a value is not finite or not valid: images larger than 16,384 px,
/// positions beyond 10,000 km, matrices that are no rotations, features outside the image or the
/// pyramid.
void check_values(const Camera& camera);
void check_values(const Landmark& landmark);
void check_values(const KeyFrame& keyframe);

}  // namespace stillpoint
