#include "evaluation/evaluation.hpp"

#include <Eigen/Eigenvalues>
#include <utility>

#include "evaluation/format.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr std::size_t kMinPairs = 3;  // fewer positions do not determine an alignment
// Least extent of the reference, as a standard deviation of positions, in RMSEs of the error after
// Sim(3) alignment: about the inverse of the relative error of the scale, and of a rotation's error
// in radians.
constexpr double kMinExtent = 5;

std::string range_text(const Trajectory& trajectory, double offset) {
  return fixed(trajectory.start() + offset, 3) + " to " + fixed(trajectory.end() + offset, 3) +
         " s (" + trajectory.name + ")";
}

/// Also where the counted times happen to lie near the measured ones: pairs would be wrong by ever
/// more frames.
void require_times_of_both_or_neither(const Trajectory& reference, const Trajectory& estimate) {
  if (reference.has_times == estimate.has_times) return;
  const Trajectory& counted = reference.has_times ? estimate : reference;
  const Trajectory& timed = reference.has_times ? reference : estimate;
  throw Error(
      Fault::kData,
      "has no time stamps (the format of KITTI), and " + timed.name +
          " has: which poses belong together is not known",
      counted.name,
      "write both with times, 'time tx ty tz qx qy qz qw', or both in the format of KITTI, a line "
      "per frame");
}

[[noreturn]] void throw_too_few_pairs(const Evaluation& e) {
  const double offset = e.options.offset;
  const bool overlap = e.estimate.start() + offset <= e.reference.end() &&
                       e.reference.start() <= e.estimate.end() + offset;
  throw Error(Fault::kData,
              std::to_string(e.pairs.size()) +
                  " poses of estimate and reference belong together within " +
                  fixed(e.options.max_difference, 3) + " s, at least " + std::to_string(kMinPairs) +
                  " are needed; the reference covers " + range_text(e.reference, 0) +
                  ", the estimate " + range_text(e.estimate, offset),
              {},
              overlap ? "a larger --max-difference or an --offset may help"
                      : "the two do not overlap in time: check that they belong to one recording, "
                        "or shift the estimate with --offset");
}

/// Standard deviations of the reference's positions along its principal axes, by falling size, m.
Eigen::Vector3d extent_of_reference(const Evaluation& e) {
  Eigen::Matrix3Xd positions(3, e.pairs.size());
  for (std::size_t i = 0; i < e.pairs.size(); ++i)
    positions.col(static_cast<Eigen::Index>(i)) =
        e.reference.poses[e.pairs[i].first].world_from_camera.translation();
  positions.colwise() -= positions.rowwise().mean().eval();
  const Eigen::Matrix3d covariance =
      positions * positions.transpose() / static_cast<double>(e.pairs.size());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .cwiseMax(0)
      .cwiseSqrt()
      .reverse();
}

}  // namespace

Evaluation evaluate(Trajectory reference, Trajectory estimate,
                    const std::vector<double>& frame_times, const EvaluationOptions& options) {
  require_times_of_both_or_neither(reference, estimate);
  Evaluation e{
      .options = options, .reference = std::move(reference), .estimate = std::move(estimate)};
  e.pairs = associate(times_of(e.reference), times_of(e.estimate), options.max_difference,
                      options.offset);
  if (e.pairs.size() < kMinPairs) throw_too_few_pairs(e);
  e.rigid = absolute_error(e.reference, e.estimate, e.pairs, AlignmentKind::kRigid);
  e.similarity = absolute_error(e.reference, e.estimate, e.pairs, AlignmentKind::kSimilarity);
  const Eigen::Vector3d extent = extent_of_reference(e);
  const double least = kMinExtent * e.similarity.metres.rmse;
  if (extent.norm() >= least) e.scale = e.similarity.reference_from_estimate.scale;
  if (extent[1] >= least) e.rigid_rotation_deg = e.rigid.rotation_deg;
  e.relative = relative_error(e.reference, e.estimate, options.delta, options.offset);
  e.span = span_coverage(e.reference, e.estimate, options.offset);
  if (!frame_times.empty())
    e.frames = frame_coverage(frame_times, e.estimate, options.max_difference);
  return e;
}

}  // namespace stillpoint::evaluation
