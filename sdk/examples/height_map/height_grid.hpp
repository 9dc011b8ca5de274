// The height of the ground, cell by cell.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <stillpoint/options.hpp>
#include <vector>

#include "floor.hpp"

struct GridOptions {
  double resolution = 0.05;  ///< metres
  double min_height = -0.5;  ///< metres above the floor
  double max_height = 1.8;   ///< metres above the floor
  int min_points = 3;        ///< of a cell

  void visit(stillpoint::OptionVisitor& v);
};

/// A 2.5D map. Its frame lies on the floor: x along the view of the first camera, y to the left, z
/// up, the origin below that camera.
struct HeightGrid {
  cv::Mat heights;        ///< CV_32FC1, metres above the floor; first row: largest y
  cv::Mat known;          ///< CV_8UC1, 255 where the height is known
  double resolution = 0;  ///< metres, side of a cell
  Eigen::Vector2f corner = Eigen::Vector2f::Zero();  ///< metres, smallest x and y
  Eigen::Isometry3f map_from_world = Eigen::Isometry3f::Identity();

  cv::Point cell_of(const Eigen::Vector3f& point_in_map) const;
};

HeightGrid make_grid(const std::vector<Eigen::Vector3f>& points_in_world, const Floor& floor,
                     const GridOptions& options);

/// height_map.png (16 bits), height_map.yaml (what its values mean) and height_map_view.png, to
/// look at.
void save(const HeightGrid& grid, const GridOptions& options,
          const std::filesystem::path& directory);
