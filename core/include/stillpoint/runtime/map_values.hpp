// Valid values in a saved map: a malicious file may have correct checksums.
#pragma once

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/landmark.hpp"

namespace stillpoint {

/// Whether all values are finite and could be those of a camera.
bool possible(const Camera& camera);

/// Each throws DamagedMap when a value is not finite or not valid: images larger than 16,384 px,
/// positions beyond 10,000 km, matrices that are no rotations, features outside the image or the
/// pyramid.
void check_values(const Camera& camera);
void check_values(const Landmark& landmark);
void check_values(const KeyFrame& keyframe);

}  // namespace stillpoint
