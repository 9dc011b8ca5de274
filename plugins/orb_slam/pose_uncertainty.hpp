// The covariance of a pose from the information matrix of its measurements.
#pragma once

#include "stillpoint/contracts/tracker.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

/// `information` of the camera's pose in its own frame, translation (m), then rotation (rad). In
/// directions without any information the standard deviation is 1 m or 1 rad.
PoseUncertainty uncertainty_of(const Matrix6d& information);

/// Whether the measurements suffice: standard deviations below 10 mm and 10 mrad.
bool is_well_constrained(const Matrix6d& information);

Matrix6d inverse(const Matrix6d& positive_definite);

}  // namespace stillpoint::orb_slam
