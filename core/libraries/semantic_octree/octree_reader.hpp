// Reads the files of a saved dense map, ours and those of any program with OctoMap.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "semantic_octree/map_files.hpp"
#include "semantic_octree/semantic_octree.hpp"

namespace stillpoint::semantic_octree {

/// 4 GiB: a hundred million nodes.
constexpr std::size_t kMostOctreeMemory = std::size_t{4} << 30;

struct SavedOctree {
  std::unique_ptr<SemanticOctree> tree;  ///< never empty
  MapClasses classes;                    ///< no names: the file says nothing about classes
  bool has_colors = false;
};

/// An .ot file of a ColorOcTree or an OcTree, with or without classes behind the tree, or a .bt
/// file; what it is stands in its first line. OctoMap's own readers trust a damaged file and may
/// never return. Throws Error(kData) for a file that is none of these, damaged or empty, and where
/// the file or its tree takes more than `most_memory` bytes.
SavedOctree read_octree(const std::filesystem::path& file,
                        std::size_t most_memory = kMostOctreeMemory);

}  // namespace stillpoint::semantic_octree
