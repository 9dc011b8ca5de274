// What a saved dense map holds.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "semantic_octree/cost_map.hpp"
#include "semantic_octree/octree_reader.hpp"

namespace stillpoint::dense_map {

using semantic_octree::CostMapOptions;
using semantic_octree::FloorPlane;
using semantic_octree::SavedOctree;

struct ClassShare {
  std::string name;
  std::size_t voxels = 0;  ///< occupied ones
  double confidence = 0;   ///< mean over them
};

struct MapSummary {
  double resolution = 0;                        ///< metres
  std::size_t occupied = 0, free = 0;           ///< voxels
  std::size_t nodes = 0, memory = 0;            ///< of the tree; bytes
  Eigen::Vector3d low{0, 0, 0}, high{0, 0, 0};  ///< box around what is occupied, metres in world
  bool has_colors = false;
  std::optional<FloorPlane> floor;
  std::vector<ClassShare> classes;  ///< those that occur, most voxels first; empty: unknown

  /// Square metres of occupied voxels seen flat.
  double surface() const { return static_cast<double>(occupied) * resolution * resolution; }
};

/// The floor is that of the options, or found.
MapSummary summarise(const SavedOctree& map, const CostMapOptions& options = {});

std::string summary_table(const MapSummary& summary, const std::string& name);
nlohmann::json summary_json(const MapSummary& summary);

}  // namespace stillpoint::dense_map
