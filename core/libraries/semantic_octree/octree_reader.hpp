// Reads the files of a saved dense map, ours and those of any program with OctoMap.
#pragma once

#include <filesystem>
#include <memory>

#include "semantic_octree/map_files.hpp"
#include "semantic_octree/semantic_octree.hpp"

namespace stillpoint::semantic_octree {

struct SavedOctree {
  std::unique_ptr<SemanticOctree> tree;  ///< never empty
  MapClasses classes;                    ///< no names: the file says nothing about classes
  bool has_colors = false;
};

/// An .ot file of a ColorOcTree or an OcTree, with or without classes behind the tree, or a .bt
/// file; what it is stands in its first line. OctoMap's own readers trust a damaged file and may
/// never return. Throws Error(kData) for a file that is none of these, damaged or empty.
SavedOctree read_octree(const std::filesystem::path& file);

}  // namespace stillpoint::semantic_octree
