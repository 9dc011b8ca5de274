#include "evaluation/absolute_error.hpp"

#include <cmath>
#include <utility>

namespace stillpoint::evaluation {

namespace {

constexpr double kDegrees = 180.0 / M_PI;

/// Least squares in the plane (Umeyama's with one angle), the mean in height.
Alignment align_yaw(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target) {
  const Eigen::Vector3d source_mean = source.rowwise().mean(),
                        target_mean = target.rowwise().mean();
  double cosine = 0.0, sine = 0.0;
  for (Eigen::Index i = 0; i < source.cols(); ++i) {
    const Eigen::Vector3d s = source.col(i) - source_mean, t = target.col(i) - target_mean;
    cosine += s.x() * t.x() + s.y() * t.y();
    sine += s.x() * t.y() - s.y() * t.x();
  }
  Alignment result;
  result.target_from_source.linear() =
      Eigen::AngleAxisd(std::atan2(sine, cosine), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  result.target_from_source.translation() =
      target_mean - result.target_from_source.linear() * source_mean;
  return result;
}

}  // namespace

AbsoluteError absolute_error(const Trajectory& reference, const Trajectory& estimate,
                             std::span<const TimePair> pairs, AlignmentKind kind) {
  Eigen::Matrix3Xd reference_points(3, pairs.size()), estimate_points(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    reference_points.col(i) = reference.poses[pairs[i].first].world_from_camera.translation();
    estimate_points.col(i) = estimate.poses[pairs[i].second].world_from_camera.translation();
  }
  AbsoluteError result;
  Alignment& alignment = result.reference_from_estimate;
  if (kind == AlignmentKind::kYaw)
    alignment = align_yaw(estimate_points, reference_points);
  else if (kind == AlignmentKind::kOrigin)
    alignment.target_from_source = reference.poses[pairs.front().first].world_from_camera *
                                   estimate.poses[pairs.front().second].world_from_camera.inverse();
  else if (kind != AlignmentKind::kNone)
    alignment = align_points(estimate_points, reference_points, kind == AlignmentKind::kSimilarity);
  std::vector<double> degrees;
  for (const TimePair& pair : pairs) {
    const Eigen::Vector3d position =
        aligned(result.reference_from_estimate, estimate.poses[pair.second]);
    result.per_pair.push_back(
        (position - reference.poses[pair.first].world_from_camera.translation()).norm());
    const Pose turned =
        alignment.target_from_source * estimate.poses[pair.second].world_from_camera;
    degrees.push_back(
        kDegrees *
        rotation_angle(reference.poses[pair.first].world_from_camera.inverse() * turned));
  }
  result.metres = statistics_of(result.per_pair);
  result.rotation_deg = statistics_of(std::move(degrees));
  return result;
}

std::vector<StampedPose> aligned(const Alignment& reference_from_estimate,
                                 const Trajectory& estimate) {
  std::vector<StampedPose> poses = estimate.poses;
  for (StampedPose& pose : poses) {
    const Eigen::Vector3d position = aligned(reference_from_estimate, pose);
    pose.world_from_camera = reference_from_estimate.target_from_source * pose.world_from_camera;
    pose.world_from_camera.translation() = position;
  }
  return poses;
}

Eigen::Vector3d aligned(const Alignment& reference_from_estimate, const StampedPose& estimate) {
  return reference_from_estimate.target_from_source *
         (reference_from_estimate.scale * estimate.world_from_camera.translation());
}

}  // namespace stillpoint::evaluation
