// A smooth closed path on the floor, parametrised by arc length.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace stillpoint::simulation {

class WalkingPath {
 public:
  /// Catmull–Rom spline through three or more points, x, y, x, y, … in metres.
  explicit WalkingPath(const std::vector<double>& points);

  /// Position `way` metres from the first point, round and round.
  Eigen::Vector2d at(double way) const;
  /// Radians from +x towards +y; turns smoothly, as bodies do.
  double heading(double way) const;
  double length() const { return kStep * static_cast<double>(samples_.size()); }

 private:
  static constexpr double kStep = 0.02;  // metres between samples

  std::vector<Eigen::Vector2d> samples_;
};

}  // namespace stillpoint::simulation
