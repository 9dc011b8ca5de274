// The surface at a pixel, and whether a depth discontinuity makes it ambiguous.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "stillpoint/options.hpp"

namespace stillpoint::moving_checks {

struct SurfaceOptions {
  int edge_radius = 6;      ///< px
  double edge_jump = 0.08;  ///< m

  void visit(OptionVisitor& v);
};

struct Surface {
  enum class Kind {
    kMeasured,  ///< one smooth surface all around
    kNone,      ///< nothing measured anywhere near
    kEdge,      ///< surfaces of different depth meet here: a corner may belong to either or neither
  } kind = Kind::kNone;
  double inverse_depth = 0;  ///< 1/m
};

/// The surface around a pixel of a depth image (CV_32FC1, metres, 0 = no measurement) whose inverse
/// depths have the standard deviation `noise` (1/m).
Surface surface_at(const cv::Mat& depth, const cv::Point2f& pixel, double noise,
                   const SurfaceOptions& options);

}  // namespace stillpoint::moving_checks
