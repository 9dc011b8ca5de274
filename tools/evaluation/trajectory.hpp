// Trajectories as text: one pose per line, in metres, camera in the world. The columns tell the
// format:
//   TUM RGB-D  `time tx ty tz qx qy qz qw`, seconds
//   EuRoC      `time,tx,ty,tz,qw,qx,qy,qz[,…]`, nanoseconds; with blanks for commas the
//              quaternion is that of TUM, as ORB-SLAM3 writes it
//   KITTI      the three rows of a 3 x 4 matrix, no time; ten poses a second
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stillpoint/pose_math.hpp"

namespace stillpoint::evaluation {

/// Poses by strictly rising time; at least one.
struct Trajectory {
  std::string name;  ///< the file, for messages
  std::vector<StampedPose> poses;
  int repeated_stamps = 0;  ///< lines left out because a later one has the same time
  bool has_times = true;    ///< false: its format has none, and the poses were counted

  double start() const { return poses.front().time; }
  double end() const { return poses.back().time; }
  double duration() const { return end() - start(); }
};

/// Quaternions are normalised, times are seconds. Of several poses with one time stamp the last one
/// counts, as in the scripts of the benchmark. Throws Error(kData) with file and line for anything
/// else that is not as described above.
Trajectory read_trajectory(const std::filesystem::path& file);

/// In the format of TUM RGB-D. Throws Error(kUsage) when it cannot be written.
void write_trajectory(const std::filesystem::path& file, const std::vector<StampedPose>& poses);

/// Where the camera was at any time (seconds): between two rows, or at the nearer end.
Pose pose_at(const Trajectory& trajectory, double time);

std::vector<double> times_of(const Trajectory& trajectory);

/// Median time in seconds between successive poses; 0 for a single one.
double median_interval(const Trajectory& trajectory);

/// The first column of a list such as rgb.txt or associations.txt: times in seconds, rising.
std::vector<double> read_stamps(const std::filesystem::path& file);

}  // namespace stillpoint::evaluation
