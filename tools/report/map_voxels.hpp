// A saved dense map as the page draws it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "semantic_octree/map_files.hpp"

namespace stillpoint::report {

struct MapVoxels {
  double edge = 0;                     ///< metres, of the cubes below
  double resolution = 0;               ///< metres, of the map's own voxels
  Eigen::Vector3d corner{0, 0, 0};     ///< of the cube (0, 0, 0), metres in world
  Eigen::Vector3d up{0, 0, 0};         ///< away from the floor
  std::size_t occupied = 0;            ///< voxels of the map
  std::vector<std::uint16_t> x, y, z;  ///< cubes, in edges from the corner
  std::vector<std::uint8_t> red, green, blue;
  std::vector<std::uint8_t> label;      ///< best class; 0 when there are none
  std::vector<std::uint8_t> occupancy;  ///< probability in 1/255
  bool has_colors = false;
  semantic_octree::MapClasses classes;

  std::size_t size() const { return x.size(); }
};

/// The occupied voxels. More than `limit`: cubes twice as large, again and again, each with the
/// looks of its most probably occupied voxel. Throws Error(kData) as read_octree does.
MapVoxels read_voxels(const std::filesystem::path& octree, std::size_t limit);

}  // namespace stillpoint::report
