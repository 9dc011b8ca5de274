// The files of a dense map. Each is written whole or not at all; errors throw Error(kUsage).
#pragma once

#include <filesystem>

#include "map_octomap/semantic_octree.hpp"
#include "stillpoint/class_names.hpp"

namespace stillpoint {

/// OctoMap's .ot file of a ColorOcTree, which octovis shows and every program with OctoMap reads.
/// Behind the tree follow the classes, which those pass over: a line `# stillpoint classes 1`, a
/// line of JSON ({"names": [...], "colors": [[r, g, b], ...]}), and for each leaf, in the order of
/// the tree, its class and the confidence in 1/255, a byte each.
void write_octree(const SemanticOctree& tree, const ClassNames& classes,
                  const std::filesystem::path& file);
/// OctoMap's .bt file: occupied or free.
void write_occupancy(const SemanticOctree& tree, const std::filesystem::path& file);
/// The occupied voxels, by write_ply().
void write_point_cloud(const SemanticOctree& tree, const ClassNames& classes,
                       const std::filesystem::path& file);

}  // namespace stillpoint
