// Which points of the image rays are cast through.
#pragma once

#include <array>
#include <cstddef>

#include "simulation/ray_caster.hpp"

namespace stillpoint::simulation {

inline constexpr int kPacketWidth = 4;  // px
inline constexpr int kPacketHeight = 2;
inline constexpr std::size_t kFew = 4;   // samples where surfaces move past each other
inline constexpr std::size_t kMany = 8;  // samples where they do so fast; the most anywhere

/// At an edge that stands still, besides the view of the pixel's centre.
inline constexpr std::size_t kEdgeViews = 2;
inline constexpr std::size_t kEdgePixels = kPacket / kEdgeViews;  ///< whose views make a packet

/// Columns and rows of the samples of a pixel in a grid of kFew or kMany: each is used once,
/// so that the mean stays at the pixel's centre, and in an order that has nothing to do with time.
inline constexpr std::array<std::array<int, kFew>, 2> kFewCells = {{{1, 3, 0, 2}, {0, 2, 3, 1}}};
inline constexpr std::array<std::array<int, kMany>, 2> kManyCells = {
    {{0, 4, 2, 6, 1, 5, 3, 7}, {2, 7, 4, 1, 6, 3, 0, 5}}};

/// Offset in px along axis 0 (x) or 1 (y).
inline float cell_offset(std::size_t axis, std::size_t sample, std::size_t count) {
  const int cell = count == kFew ? kFewCells[axis][sample] : kManyCells[axis][sample];
  return (static_cast<float>(cell) + 0.5F) / static_cast<float>(count) - 0.5F;
}

/// Pixels whose rays are cast together; those near each other are faster.
struct Pixels {
  std::array<int, kPacket> x;
  std::array<int, kPacket> y;
};

/// Points of the image, px; integers are centres of pixels.
struct Points {
  std::array<float, kPacket> x;
  std::array<float, kPacket> y;
};

inline Points points_in(const Pixels& pixels, float dx, float dy) {
  Points points{};
  for (std::size_t i = 0; i < kPacket; ++i) {
    points.x[i] = static_cast<float>(pixels.x[i]) + dx;
    points.y[i] = static_cast<float>(pixels.y[i]) + dy;
  }
  return points;
}

}  // namespace stillpoint::simulation
