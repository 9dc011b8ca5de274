// Where in an image something that moves may be seen: everywhere else, rays meet the room alone.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
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

  bool at(int column, int row) const {
    return tiles_[static_cast<std::size_t>(row * columns_ + column)];
  }

 private:
  void mark(const Eigen::AlignedBox2f& pixels);

  Camera camera_;
  int tile_width_;
  int tile_height_;
  int columns_;
  int rows_;
  std::vector<std::uint8_t> tiles_;
};

}  // namespace stillpoint::simulation
