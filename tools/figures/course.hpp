// What figures show of runs over time.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "figures/figure.hpp"

namespace stillpoint::figures {

/// Values at rising times, seconds since the recording began.
struct Course {
  std::vector<double> seconds, values;
};

/// A line that breaks where the camera was lost between two times; values are multiplied by
/// `scale`.
Points points_of(const Course& course, const std::vector<Range>& lost, double scale = 1.0);

/// Whether a stretch touches the time between the two.
bool lost_between(const std::vector<Range>& lost, double earlier, double later);

/// The point at which lines break.
Eigen::Vector2d line_break();

/// In the colour of the run; dashed where colours come again.
Line run_line(const std::string& name, Points points, std::size_t run);

/// Puts a mark into the panel for each stretch in which a run was lost: over the whole height for
/// the only run, in a lane of its own for one of several.
void mark_lost(Panel& panel, const std::vector<Range>& lost, std::size_t run, std::size_t runs);

/// The x axis reaches over these times; as it was where there are none.
void limit_x(Panel& panel, const Range& times);

/// Metres, or millimetres where nothing is larger than one metre.
struct LengthUnit {
  std::string name;
  double per_metre;
};
LengthUnit unit_for(double largest_m);

/// Of finite values; 0 of none.
double largest_of(const std::vector<double>& values);

}  // namespace stillpoint::figures
