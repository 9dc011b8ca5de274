// Everything `stillpoint evaluate` finds out about an estimated trajectory.
#pragma once

#include <optional>
#include <vector>

#include "evaluation/absolute_error.hpp"
#include "evaluation/association.hpp"
#include "evaluation/coverage.hpp"
#include "evaluation/relative_error.hpp"
#include "evaluation/trajectory.hpp"

namespace stillpoint::evaluation {

struct EvaluationOptions {
  double max_difference = 0.02;  ///< seconds between poses that belong together
  double offset = 0;             ///< seconds, added to the times of the estimate
  Delta delta;                   ///< of the relative pose error
};

struct Evaluation {
  EvaluationOptions options;
  Trajectory reference, estimate;
  std::vector<TimePair> pairs;  ///< (reference, estimate)
  AbsoluteError rigid, similarity;
  /// Scale of `similarity`: the estimate times this fits the reference. Nothing where positions do
  /// not determine it: the path is not much larger than the error.
  std::optional<double> scale;
  /// Of `rigid`, between orientations, degrees. Nothing where positions do not determine the
  /// alignment's rotation: the path is not much larger than the error, or nearly on a line.
  std::optional<Statistics> rigid_rotation_deg;
  std::optional<RelativeError> relative;  ///< none when the recording is shorter than the delta
  SpanCoverage span;
  std::optional<FrameCoverage> frames;  ///< with a list of the recording's frames
};

/// `frame_times` (of the estimate's clock, rising) may be empty: not known. Throws Error(kData)
/// when fewer than three poses belong together.
Evaluation evaluate(Trajectory reference, Trajectory estimate,
                    const std::vector<double>& frame_times, const EvaluationOptions& options);

}  // namespace stillpoint::evaluation
