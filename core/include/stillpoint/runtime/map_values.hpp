// Which values the parts of a saved map may have: a file may be made to harm, with right checksums.
#pragma once

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/landmark.hpp"

namespace stillpoint {

/// Each throws DamagedMap when a value is not finite or beyond what can be: images up to 16,384 px,
/// positions within 10,000 km, rotations that are none, features outside the image or the pyramid.
void check_values(const Camera& camera);
void check_values(const Landmark& landmark);
void check_values(const KeyFrame& keyframe);

}  // namespace stillpoint
