// The motion of the camera between two RGB-D frames.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::moving {

/// A point measured in both frames.
struct RigidMatch {
  Eigen::Vector3d in_previous;  ///< metres, camera frame
  Eigen::Vector3d in_current;   ///< metres, camera frame
  Eigen::Vector2d pixel;        ///< px, in the current image
  double weight = 1.0;          ///< 0 … 1, how far the point is known to stand still
};

/// Standard deviations of a match. Depth of a structured-light sensor is equally good everywhere in
/// inverse depth: its deviation in metres grows with z² (Khoshelham and Elberink, Sensors 2012).
struct RigidNoise {
  double pixel = 0.4;            ///< px
  double inverse_depth = 0.004;  ///< 1/m
};

struct RigidMotion {
  Pose current_from_previous = Pose::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< inverse covariance of the pose's tangent
  std::vector<bool> inlier;                 ///< per match
  int inliers = 0;
  double agreement = 0;  ///< share of the matches that are inliers, by weight
};

/// 3-D/3-D RANSAC: samples of three matches are aligned, refined, and compared by how many matches
/// they explain in the image and in depth, by weight; `guesses` compete with them. The best one is
/// refined with all its inliers. Nothing when there are fewer than three matches or no sample
/// determines a motion.
std::optional<RigidMotion> find_rigid_motion(std::span<const RigidMatch> matches,
                                             const Camera& camera, const RigidNoise& noise,
                                             std::span<const Pose> guesses, int samples,
                                             std::uint64_t seed);

/// Standard deviation in px that the motion's uncertainty gives to a point in the current camera
/// frame.
double pixel_uncertainty(const RigidMotion& motion, const Camera& camera,
                         const Eigen::Vector3d& point_in_current);

}  // namespace stillpoint::moving
