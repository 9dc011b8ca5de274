// One line of a TUM trajectory file.
#pragma once

#include <ostream>

#include "stillpoint/export.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint {

/// `time tx ty tz qx qy qz qw`, with qw >= 0; seconds and metres.
STILLPOINT_EXPORT void write_tum_pose(std::ostream& stream, double time,
                                      const Pose& world_from_camera);

}  // namespace stillpoint
