// The files of a dense map. Each is written whole or not at all; errors throw Error(kUsage).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "semantic_octree/semantic_octree.hpp"
#include "stillpoint/class_names.hpp"
#include "stillpoint/contracts/labelled_point.hpp"

namespace stillpoint::semantic_octree {

/// What the class ids in a map mean.
struct MapClasses {
  ClassNames names;                                 ///< by id; empty: nothing is known of classes
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< red, green, blue; one per name
};
/// With the colours that classes have everywhere.
MapClasses with_colors(const ClassNames& names);

/// Calls `function(centre, voxel)` for every occupied voxel. A leaf that is larger, since its
/// voxels are all the same, counts as so many.
template <typename Function>
void for_each_occupied_voxel(const SemanticOctree& tree, Function&& function) {
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const int edge = 1 << (tree.getTreeDepth() - leaf.getDepth());
    const double size = tree.getResolution(), first = 0.5 * (1 - edge) * size;
    const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z)
          function(Eigen::Vector3d(centre + Eigen::Vector3d::Constant(first) +
                                   size * Eigen::Vector3d(x, y, z)),
                   *leaf);
  }
}

/// OctoMap's .ot file of a ColorOcTree, which octovis shows and every program with OctoMap reads.
/// Behind the tree follow the classes, which those pass over: a line `# stillpoint classes 1`, a
/// line of JSON ({"names": [...], "colors": [[r, g, b], ...], "occupied_above": p}), and for each
/// leaf, in the order of the tree, its class and the confidence in 1/255, a byte each.
void write_octree(const SemanticOctree& tree, const MapClasses& classes,
                  const std::filesystem::path& file);
/// OctoMap's .bt file: occupied or free.
void write_occupancy(const SemanticOctree& tree, const std::filesystem::path& file);
/// The occupied voxels, by write_ply().
void write_point_cloud(const SemanticOctree& tree, const MapClasses& classes,
                       const std::filesystem::path& file);

/// A point at the centre of each occupied voxel.
std::vector<LabelledPoint> occupied_points(const SemanticOctree& tree);

}  // namespace stillpoint::semantic_octree
