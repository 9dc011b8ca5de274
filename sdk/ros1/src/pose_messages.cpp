#include "pose_messages.hpp"

namespace stillpoint_ros {

using stillpoint::Matrix6d;
using stillpoint::Pose;

geometry_msgs::Pose pose_message(const Pose& pose) {
  const geometry_msgs::Transform transform = transform_message(pose);
  geometry_msgs::Pose message;
  message.position.x = transform.translation.x;
  message.position.y = transform.translation.y;
  message.position.z = transform.translation.z;
  message.orientation = transform.rotation;
  return message;
}

geometry_msgs::Transform transform_message(const Pose& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::Transform message;
  message.translation.x = pose.translation().x();
  message.translation.y = pose.translation().y();
  message.translation.z = pose.translation().z();
  message.rotation.x = rotation.x();
  message.rotation.y = rotation.y();
  message.rotation.z = rotation.z();
  message.rotation.w = rotation.w();
  return message;
}

Pose pose_of(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& q = transform.rotation;
  Pose pose(Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized());
  pose.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  return pose;
}

// An error d of the camera, in its frame, is Ad(base_from_camera) d of the base, in its frame.
geometry_msgs::PoseWithCovariance::_covariance_type covariance_message(const Matrix6d& in_camera,
                                                                       const Pose& base_from_camera,
                                                                       const Pose& map_from_base) {
  const Eigen::Matrix3d rotation = base_from_camera.linear();
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = rotation;
  adjoint.topRightCorner<3, 3>() = stillpoint::skew(base_from_camera.translation()) * rotation;
  adjoint.bottomRightCorner<3, 3>() = rotation;
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = map_from_base.linear();
  const Matrix6d jacobian = turn * adjoint;
  const Matrix6d in_map = jacobian * in_camera * jacobian.transpose();
  geometry_msgs::PoseWithCovariance::_covariance_type message;
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.data()) = in_map;
  return message;
}

}  // namespace stillpoint_ros
