// What earlier views say of each surface that is seen now.
#pragma once

#include <span>

#include "map_checks/view_memory.hpp"

namespace stillpoint::map_checks {

struct VerdictOptions {
  double margin = 0.04;         ///< m, by which something must stand before what was seen
  double tolerance = 0.015;     ///< m, within which it stands where it stood
  double rest_time = 5.0;       ///< s, after which what has come in and stays counts as staying
  double min_age = 1.0;         ///< s; younger views from the same place do not tell who rests
  double min_parallax = 0.1;    ///< m between the viewpoints; then younger ones do
  double came_in = 3.0;         ///< log-odds, of each view that looked through the place
  double same_mapped = 1.5;     ///< log-odds, of each view that saw it there and mapped it
  double same_tracked = 0.3;    ///< log-odds, of each that only tracked it
  double same_untrusted = 0.3;  ///< log-odds, of each that did neither
  double range = 8.0;           ///< log-odds, most
  double reach = 0.5;           ///< m, along a surface from where it has come in to unknown space

  void visit(OptionVisitor& visitor);
};

/// CV_32FC1, log-odds that the surface of a cell moves; see MapEvidence. `views` newest first, at
/// their present poses; `time` in seconds.
cv::Mat judge_surfaces(const cv::Mat& depth, const CellCamera& camera,
                       const Pose& world_from_camera, double time,
                       std::span<const View* const> views, const VerdictOptions& options);

}  // namespace stillpoint::map_checks
