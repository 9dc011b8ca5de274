// Where two dense maps say different things.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "semantic_octree/octree_reader.hpp"
#include "stillpoint/support/point_cloud_file.hpp"

namespace stillpoint::dense_map {

using semantic_octree::SavedOctree;

/// Counts of voxels.
struct MapDifference {
  std::size_t both = 0;                         ///< occupied in both
  std::size_t only_first = 0, only_second = 0;  ///< occupied in one
  /// Of those, with an occupied voxel of the other map among the 26 around.
  std::size_t near_second = 0, near_first = 0;
  /// Of those, free in the other map: seen to be empty, not only unseen.
  std::size_t gone = 0, appeared = 0;
  std::size_t other_class = 0;  ///< of `both`: of another class
  bool classes = false;         ///< both maps have them
  /// Occupied in one only; label 1: in the first (red), 2: in the second (green).
  std::vector<LabelledPoint> points;

  double overlap() const;  ///< both ÷ occupied in any; 1 when nothing is
};

/// Voxel by voxel in world coordinates; classes are compared by name. Throws Error(kUsage) for maps
/// of different resolutions.
MapDifference compare(const SavedOctree& first, const SavedOctree& second);

std::string difference_table(const MapDifference& difference, const std::string& first,
                             const std::string& second);
nlohmann::json difference_json(const MapDifference& difference);

}  // namespace stillpoint::dense_map
