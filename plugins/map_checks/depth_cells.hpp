// A depth image on a coarse grid, and its surfaces.
#pragma once

#include <stillpoint/sdk.hpp>

namespace stillpoint::map_checks {

inline constexpr int kCell = 4;  // px, the side of a cell
inline constexpr int kCellMiddle = kCell / 2;

/// Pinhole camera whose pixels are cells.
struct CellCamera {
  float fx = 0, fy = 0, cx = 0, cy = 0;  ///< cells
  float surface_noise = 0;               ///< as in Camera

  explicit CellCamera(const Camera& camera);
  Eigen::Vector3f unproject(float x, float y, float z) const {
    return {(x - cx) / fx * z, (y - cy) / fy * z, z};
  }
};

/// CV_32FC1: the depth in the middle of each cell, metres. Stereo and time of flight leave
/// scattered holes: where the middle has none, it is the median of the cell if at least half of it
/// has depth and is on one surface; else 0.
cv::Mat sample_depth(const cv::Mat& depth);

/// CV_32FC2: the nearest and the farthest depth of a cell and its eight neighbours, so that an
/// error of one cell by the pose changes no result; (0, 0) where the cell has none.
cv::Mat depth_bounds(const cv::Mat& cells);

/// CV_32FC3: unit normals in the camera frame; 0 at depth edges and where depth is missing.
cv::Mat surface_normals(const cv::Mat& cells, const CellCamera& camera);

}  // namespace stillpoint::map_checks
