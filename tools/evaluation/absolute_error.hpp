// Absolute trajectory error (Sturm et al., A Benchmark for the Evaluation of RGB-D SLAM Systems,
// IROS 2012): distances between positions after the best alignment of the whole trajectories.
#pragma once

#include <span>
#include <vector>

#include "evaluation/association.hpp"
#include "evaluation/statistics.hpp"
#include "evaluation/trajectory.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::evaluation {

enum class AlignmentKind {
  kRigid,       ///< SE(3): what the benchmark prints
  kSimilarity,  ///< Sim(3): the scale is fitted, too
  kYaw,         ///< turn about the reference's z axis and translation: gravity is known
  kOrigin,      ///< the first poses fall together
  kNone,
};

struct AbsoluteError {
  Statistics metres;
  Statistics rotation_deg;  ///< between orientations; means something where both are of one body
  Alignment reference_from_estimate;
  std::vector<double> per_pair;  ///< metres, in the order of the pairs
};

/// `pairs` index (reference, estimate); at least one.
AbsoluteError absolute_error(const Trajectory& reference, const Trajectory& estimate,
                             std::span<const TimePair> pairs, AlignmentKind kind);

/// The whole estimate beside the reference; its times stay.
std::vector<StampedPose> aligned(const Alignment& reference_from_estimate,
                                 const Trajectory& estimate);

/// A position of the estimate, as the alignment places it beside the reference.
Eigen::Vector3d aligned(const Alignment& reference_from_estimate, const StampedPose& estimate);

}  // namespace stillpoint::evaluation
