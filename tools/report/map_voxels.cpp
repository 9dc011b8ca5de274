#include "report/map_voxels.hpp"

#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <vector>

#include "semantic_octree/octree_reader.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::report {
namespace {

using semantic_octree::SavedOctree;
using semantic_octree::SemanticVoxel;

constexpr std::uintmax_t kLargestCostMap = 1 << 16;  // bytes, of its description

struct Cube {
  std::uint64_t key = 0;  // 16 bits each: x, y, z in voxels of the map
  const SemanticVoxel* voxel = nullptr;
};

std::uint64_t key_of(const Eigen::Vector3d& steps) {
  const auto bits = [&](int axis) { return static_cast<std::uint64_t>(std::lround(steps[axis])); };
  return bits(0) << 32 | bits(1) << 16 | bits(2);
}

std::uint64_t halved(std::uint64_t key) { return key >> 1 & 0x7fff'7fff'7fffu; }

std::vector<Cube> merged(const std::vector<Cube>& cubes) {
  std::unordered_map<std::uint64_t, std::size_t> places;
  std::vector<Cube> result;
  for (const Cube& cube : cubes) {
    const std::uint64_t key = halved(cube.key);
    const auto [place, is_new] = places.emplace(key, result.size());
    if (is_new)
      result.push_back({key, cube.voxel});
    else if (cube.voxel->getLogOdds() > result[place->second].voxel->getLogOdds())
      result[place->second].voxel = cube.voxel;
  }
  return result;
}

Eigen::Vector3d corner_of(const SavedOctree& map) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::max());
  for_each_occupied_voxel(
      *map.tree, [&](const Eigen::Vector3d& at, const SemanticVoxel&) { low = low.cwiseMin(at); });
  return low;
}

/// Away from the floor that the run has found, which stands in the cost map's file; without one,
/// the up of the first camera.
Eigen::Vector3d up_beside(const std::filesystem::path& octree) {
  const Eigen::Vector3d camera_up(0, -1, 0);
  try {
    const std::filesystem::path cost_map = octree.parent_path() / "map.yaml";
    const std::string text = read_input_file(cost_map, kLargestCostMap);
    const auto pose = YAML::Load(text)["world_from_map"].as<std::vector<double>>();
    if (pose.size() != 7) return camera_up;
    const Eigen::Quaterniond world_from_map(pose[6], pose[3], pose[4], pose[5]);
    return world_from_map.normalized() * Eigen::Vector3d::UnitZ();
  } catch (const YAML::Exception&) {
    return camera_up;
  } catch (const Error&) {  // there is none
    return camera_up;
  }
}

void append(MapVoxels& voxels, const Cube& cube) {
  const auto part = [&](int shift) {
    return static_cast<std::uint16_t>(cube.key >> shift & 0xffff);
  };
  voxels.x.push_back(part(32));
  voxels.y.push_back(part(16));
  voxels.z.push_back(part(0));
  const octomap::ColorOcTreeNode::Color& color = cube.voxel->getColor();
  voxels.red.push_back(color.r);
  voxels.green.push_back(color.g);
  voxels.blue.push_back(color.b);
  voxels.label.push_back(cube.voxel->classes().best());
  voxels.occupancy.push_back(
      static_cast<std::uint8_t>(std::lround(255.0 * cube.voxel->getOccupancy())));
}

}  // namespace

MapVoxels read_voxels(const std::filesystem::path& octree, std::size_t limit) {
  const SavedOctree map = semantic_octree::read_octree(octree);
  MapVoxels voxels{.edge = map.tree->getResolution(), .resolution = map.tree->getResolution()};
  voxels.has_colors = map.has_colors;
  voxels.classes = map.classes;
  const Eigen::Vector3d low = corner_of(map);
  std::vector<Cube> cubes;
  for_each_occupied_voxel(*map.tree, [&](const Eigen::Vector3d& at, const SemanticVoxel& voxel) {
    cubes.push_back({key_of((at - low) / voxels.resolution), &voxel});
  });
  voxels.occupied = cubes.size();
  for (; cubes.size() > limit; voxels.edge *= 2) cubes = merged(cubes);
  voxels.corner = low.array() - 0.5 * voxels.resolution;
  voxels.up = up_beside(octree);
  for (const Cube& cube : cubes) append(voxels, cube);
  return voxels;
}

}  // namespace stillpoint::report
