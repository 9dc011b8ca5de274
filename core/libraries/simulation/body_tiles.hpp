// Where in an image something that moves may be seen: everywhere else, rays meet the room alone.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "simulation/eye.hpp"
#include "simulation/world.hpp"
#include "stillpoint/contracts/camera.hpp"

namespace stillpoint::simulation {

/// An image in tiles of `tile_width` x `tile_height` px, from its upper left corner.
class BodyTiles {
 public:
  BodyTiles(const Camera& camera, int tile_width, int tile_height);

  /// `eyes` and `world_from_body` are those of the same moments, first and last included; bodies
  /// and camera move evenly in between. `box` holds the body, in its own frame.
  void add(const Eigen::AlignedBox3f& box, std::span<const Eigen::Affine3f> world_from_body,
           std::span<const Eye> eyes);

  bool at(int column, int row) const { return tiles_.at<std::uint8_t>(row, column) != 0; }

 private:
  cv::Point2f tile_of(const Eigen::Vector3f& point_in_camera) const;
  void mark(const std::vector<cv::Point2f>& corners);

  Camera camera_;
  cv::Size tile_;  // px
  cv::Mat tiles_;  // CV_8UC1
};

}  // namespace stillpoint::simulation
