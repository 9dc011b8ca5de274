// Evidence of earlier views on each surface in the current frame.
#pragma once

#include <span>

#include "map_checks/view_memory.hpp"

namespace stillpoint::map_checks {

struct SurfaceEvidenceOptions {
  double margin = 0.04;               ///< m, in front of an earlier surface: free-space violation
  double tolerance = 0.015;           ///< m, around an earlier surface: the same surface
  double rest_time = 5.0;             ///< s, after which an object that was put down is static
  double min_age = 1.0;               ///< s; younger views from the same place are no evidence
  double min_parallax = 0.1;          ///< m between the viewpoints; then younger ones are
  double free_space_violation = 3.0;  ///< log-odds, of each view that saw free space there
  double static_mapped = 1.5;         ///< log-odds, of each view that saw it there and mapped it
  double static_tracked = 0.3;        ///< log-odds, of each that only tracked it
  double static_unused = 0.3;         ///< log-odds, of each that did neither
  double max_log_odds = 8.0;
  double reach = 0.5;  ///< m, region growing of violations over unknown space

  void visit(OptionVisitor& visitor);
};

/// CV_32FC1, log-odds that the surface of a cell moves; see MapEvidence. `views` newest first, at
/// their present poses; `time` in seconds.
cv::Mat surface_evidence(const cv::Mat& depth, const CellCamera& camera,
                         const Pose& world_from_camera, double time,
                         std::span<const View* const> views, const SurfaceEvidenceOptions& options);

}  // namespace stillpoint::map_checks
