#include "evaluation/absolute_error.hpp"

namespace stillpoint::evaluation {

AbsoluteError absolute_error(const Trajectory& reference, const Trajectory& estimate,
                             std::span<const TimePair> pairs, AlignmentKind kind) {
  Eigen::Matrix3Xd reference_points(3, pairs.size()), estimate_points(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    reference_points.col(i) = reference.poses[pairs[i].first].world_from_camera.translation();
    estimate_points.col(i) = estimate.poses[pairs[i].second].world_from_camera.translation();
  }
  AbsoluteError result;
  result.reference_from_estimate =
      align_points(estimate_points, reference_points, kind == AlignmentKind::kSimilarity);
  for (const TimePair& pair : pairs) {
    const Eigen::Vector3d position =
        aligned(result.reference_from_estimate, estimate.poses[pair.second]);
    result.per_pair.push_back(
        (position - reference.poses[pair.first].world_from_camera.translation()).norm());
  }
  result.metres = statistics_of(result.per_pair);
  return result;
}

Eigen::Vector3d aligned(const Alignment& reference_from_estimate, const StampedPose& estimate) {
  return reference_from_estimate.target_from_source *
         (reference_from_estimate.scale * estimate.world_from_camera.translation());
}

}  // namespace stillpoint::evaluation
