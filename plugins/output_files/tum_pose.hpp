// One line of a TUM trajectory file.
#pragma once

#include <ostream>
#include <stillpoint/pose_math.hpp>

namespace stillpoint::output_files {

/// `time tx ty tz qx qy qz qw`, with qw >= 0; seconds and metres.
void write_tum_pose(std::ostream& stream, double time, const Pose& world_from_camera);

}  // namespace stillpoint::output_files
