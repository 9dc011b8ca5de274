// Where somebody is and what they do, as a function of time.
#pragma once

#include <Eigen/Core>

#include "people/plans.hpp"

namespace stillpoint::people {

struct Stance {
  Eigen::Vector2d foot;      ///< m in the level frame: right and ahead
  double seated = 0;         ///< 0 standing … 1 sitting
  double walking = 0;        ///< 0 standing still … 1 walking
  double stride = 0;         ///< rad, phase of the steps
  bool to_the_left = false;  ///< where they went last
};

/// `time` in seconds from the first frame.
Stance stance_at(const PersonPlan& plan, double time);

/// Row of a timetable (time and `width` - 1 numbers each) at a time, linear in between; the first
/// and the last one beyond. Without the time.
Eigen::VectorXd at_time(const std::vector<double>& table, int width, double time);

}  // namespace stillpoint::people
