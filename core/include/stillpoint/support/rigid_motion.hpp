// The rigid motion that most of a set of 3-D matches agree on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/export.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint {

/// A point measured in two frames of reference, of which the target is a camera's.
struct RigidMatch {
  Eigen::Vector3d in_source;  ///< metres
  Eigen::Vector3d in_target;  ///< metres, camera frame
  Eigen::Vector2d pixel;      ///< px, in the image of the target
  double weight = 1.0;        ///< 0 … 1, how far the point is known to stand still
};

/// Standard deviations of a match; see Camera for that of depth.
struct RigidNoise {
  double pixel;          ///< px
  double inverse_depth;  ///< 1/m
};

struct RigidMotion {
  Pose target_from_source = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< as in PoseUncertainty
  std::vector<bool> inlier;                ///< per match
  int inliers = 0;
  double agreement = 0;  ///< share of the matches that are inliers, by weight
};

/// 3-D/3-D RANSAC: samples of three matches are aligned, refined, and compared by how many matches
/// they explain in the image and in depth, by weight; `guesses` compete with them. The best one is
/// refined with all its inliers. Nothing when there are fewer than three matches or no sample
/// determines a motion. `samples`: how many are drawn; `seed`: of the draws.
STILLPOINT_EXPORT std::optional<RigidMotion> find_rigid_motion(std::span<const RigidMatch> matches,
                                                               const Camera& camera,
                                                               const RigidNoise& noise,
                                                               std::span<const Pose> guesses,
                                                               int samples, std::uint64_t seed);

/// Standard deviation in px that the motion's uncertainty gives to a point in the target
/// camera.
STILLPOINT_EXPORT double pixel_uncertainty(const RigidMotion& motion, const Camera& camera,
                                           const Eigen::Vector3d& point_in_target);

}  // namespace stillpoint
