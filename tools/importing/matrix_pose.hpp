// Poses that are written as 4 x 4 matrices.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "stillpoint/pose_math.hpp"

namespace stillpoint::importing {

/// Nothing unless it is a rigid motion (to 1 %, made exact): data sets write infinities, zeros or
/// NaN where the camera was lost.
std::optional<Pose> pose_of(const Eigen::Matrix4d& matrix);

/// A file of 16 numbers by rows; nothing as above. Throws Error(kData) when it holds anything else.
std::optional<Pose> read_matrix_pose(const std::filesystem::path& file);

}  // namespace stillpoint::importing
