// A bit for every voxel of a cube, and rays through it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace stillpoint::semantic_octree {

/// A cube of `edge`³ voxels; z runs fastest. `edge` must be a multiple of 64, at most 1280.
class VoxelBits {
 public:
  using Index = std::int32_t;

  explicit VoxelBits(int edge)
      : edge_(edge), bytes_(static_cast<std::size_t>(edge) * edge * edge / 8 + 1) {}

  int edge() const { return edge_; }
  Index index(int x, int y, int z) const { return (x * edge_ + y) * edge_ + z; }
  /// One past all voxels; its bit may be set, and means nothing.
  Index nowhere() const { return edge_ * edge_ * edge_; }
  std::array<int, 3> place(Index index) const {
    return {index / (edge_ * edge_), index / edge_ % edge_, index % edge_};
  }

  void clear() { std::fill(bytes_.begin(), bytes_.end(), std::uint8_t{0}); }
  /// Whether it was set before.
  bool set(Index index) {
    std::uint8_t& byte = bytes_[static_cast<std::size_t>(index) / 8];
    const auto bit = static_cast<std::uint8_t>(1U << (index % 8));
    const bool before = byte & bit;
    byte |= bit;
    return before;
  }
  /// 64 voxels along z, the first one in the lowest bit; its index must be a multiple of 64.
  std::uint64_t word(Index index) const {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes_.data() + index / 8, sizeof word);
    return word;
  }

  /// Sets every voxel on the way from `origin`, in voxels from the corner of the cube, to the
  /// middle of each of `ends`, without the end itself (Amanatides and Woo, A Fast Voxel Traversal
  /// Algorithm for Ray Tracing, Eurographics 1987).
  void set_rays(const Eigen::Vector3f& origin, std::span<const Index> ends);

 private:
  int edge_;
  std::vector<std::uint8_t> bytes_;  // one more, of nowhere()
};

}  // namespace stillpoint::semantic_octree
