#include "ros2_messages/pose_messages.hpp"

#include "stillpoint/support/trajectory.hpp"

namespace stillpoint::ros2_messages {
namespace {

/// Of the base in its own frame, from one pose to the next: m/s and rad/s.
Vector6d twist_between(const StampedPose& before, const StampedPose& after) {
  const double seconds = after.time - before.time;
  if (seconds <= 0) return Vector6d::Zero();
  return log_se3(before.world_from_camera.inverse() * after.world_from_camera) / seconds;
}

/// An error d of the camera, in its frame, is Ad(base_from_camera) d of the base, in its frame; a
/// message has it with the axes of the map.
Matrix6d covariance_in_map(const Matrix6d& in_camera, const Pose& base_from_camera,
                           const Pose& map_from_base) {
  const Eigen::Matrix3d rotation = base_from_camera.linear();
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = rotation;
  adjoint.topRightCorner<3, 3>() = skew(base_from_camera.translation()) * rotation;
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = map_from_base.linear();
  const Matrix6d jacobian = turn * adjoint;
  return jacobian * in_camera * jacobian.transpose();
}

}  // namespace

std::optional<PoseMessages> PoseSequence::next(double time, const TrackResult& result) {
  if (result.state != TrackState::kTracking) {
    previous_.reset();
    return std::nullopt;
  }
  if (result.begins_anew) previous_.reset();
  const Pose map_from_base = mounting_.map_from_base(result.world_from_camera);
  const Header header{time, mounting_.map};
  PoseMessages messages{.transform = {header, mounting_.base, map_from_base},
                        .odometry = {header, mounting_.base, map_from_base},
                        .pose = {header, map_from_base}};
  if (result.uncertainty)
    messages.odometry.covariance = covariance_in_map(result.uncertainty->covariance,
                                                     mounting_.base_from_camera, map_from_base);
  const StampedPose now{time, map_from_base};
  if (previous_) messages.odometry.twist = twist_between(*previous_, now);
  previous_ = now;
  return messages;
}

Path path_of(const SparseMap& map, const std::vector<TrackedPose>& poses, const Mounting& mounting,
             double time) {
  Path path{{time, mounting.map}, {}};
  for (const TrackedPose& pose : poses)
    if (const auto in_world = world_from_camera(map, pose))
      path.poses.push_back({pose.time, mounting.map_from_base(*in_world)});
  return path;
}

}  // namespace stillpoint::ros2_messages
