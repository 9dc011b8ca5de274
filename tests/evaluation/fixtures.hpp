// Trajectories and files made for a test.
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "evaluation/trajectory.hpp"
#include "stillpoint/support/temporary_folder.hpp"

namespace stillpoint::evaluation {

/// A winding path of `count` poses, `interval` seconds apart, without symmetry.
inline Trajectory winding_path(int count, double interval) {
  Trajectory path{"path", {}, 0};
  for (int i = 0; i < count; ++i) {
    const double s = i * interval;
    Vector6d twist;
    twist << std::sin(s), std::cos(0.7 * s), 0.3 * s, 0.2 * std::sin(s), 0.1 * s, 0.4;
    path.poses.push_back({100.0 + s, exp_se3(twist)});
  }
  return path;
}

/// A file that lives as long as the object.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text) : path_(folder_.path() / name) {
    std::ofstream(path_) << text;
  }

  const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace stillpoint::evaluation
