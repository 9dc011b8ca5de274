// Pictures of dense maps, drawn without a display.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "semantic_octree/octree_reader.hpp"

namespace stillpoint::dense_map {

using semantic_octree::SavedOctree;

struct PictureOptions {
  enum class Mode { kColor, kClass } mode = Mode::kColor;
  cv::Size size{1280, 960};       ///< px
  double azimuth = 30;            ///< degrees; 0: from behind the first camera, 90: from its left
  double elevation = 50;          ///< degrees above the floor; 90: from above
  std::optional<double> highest;  ///< metres above the floor; what is higher is left out
  /// Where to look from and at, in world, metres: instead of azimuth and elevation, from which all
  /// of the map is seen.
  std::optional<Eigen::Vector3d> eye, target;
  std::vector<double> floor;  ///< as CostMapOptions::floor
};

/// The faces of occupied voxels towards free space, as seen from that side: walls do not hide what
/// is in the room. In a map without free space, all faces are drawn. CV_8UC3. Throws Error(kUsage)
/// when there is nothing to draw, no colours or classes in the map, or no floor
/// where one is needed.
cv::Mat picture_of(const SavedOctree& map, const PictureOptions& options);

/// Whole or not there; throws Error(kUsage).
void write_picture(const cv::Mat& picture, const std::filesystem::path& file);

}  // namespace stillpoint::dense_map
