// Points gathered into voxels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "stillpoint/support/majority_vote.hpp"
#include "stillpoint/support/point_cloud_file.hpp"

namespace stillpoint::map_voxel_cloud {

/// A point that stands for several.
struct VoxelPoint {
  LabelledPoint mean;  ///< its label is that of their majority
  std::uint32_t count = 0;
  bool labelled = true;  ///< whether its class is known
};

/// A hash of voxels: mean position and colour, most frequent class, number of points. Its points
/// come out in the order in which their voxels were met first.
class VoxelCloud {
 public:
  /// Edge of a voxel in metres.
  explicit VoxelCloud(double resolution) : per_metre_(static_cast<float>(1 / resolution)) {}

  /// `count` points at once; without a label they do not vote for the class. Points that
  /// are not finite or out of range (2²⁰ voxels) are left out.
  void add(const LabelledPoint& point, std::uint32_t count = 1, bool labelled = true);
  std::vector<VoxelPoint> points() const;

 private:
  struct Sum {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d rgb = Eigen::Vector3d::Zero();
    std::uint32_t count = 0;
    MajorityVote label;
    bool labelled = false;
  };

  float per_metre_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;  // of sums_, by voxel
  std::vector<Sum> sums_;
};

}  // namespace stillpoint::map_voxel_cloud
