// How many frames did not come, and how far apart they are, by the times of those that did.
#pragma once

#include <cstddef>
#include <vector>

namespace stillpoint::ros2 {

/// Images are numbered nowhere: neither their messages nor DDS say how many were lost on the way or
/// overwritten before they were taken.
class MissingFrames {
 public:
  /// Time of a frame in seconds. One that is not later than the one before does not count.
  void add(double time);
  /// An estimate, for a camera of constant rate; 0 with fewer than ten frames. A gap of n periods
  /// counts as n - 1. The period is that of the shorter intervals: the median would be twice as
  /// long if every other frame were missing.
  std::size_t count() const;
  /// Of the camera, in seconds; that of 30 Hz before there are two frames.
  double period() const;

 private:
  double last_ = 0.0;              // s
  std::vector<double> intervals_;  // s
  bool any_ = false;
};

}  // namespace stillpoint::ros2
