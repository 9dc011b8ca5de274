// Which voxels the depth image of one key frame hits, and which its rays pass through.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "semantic_octree/voxel_bits.hpp"
#include "stillpoint/contracts/map_backend.hpp"
#include "stillpoint/support/majority_vote.hpp"

namespace stillpoint::semantic_octree {

/// What a scan saw of a voxel.
struct VoxelObservation {
  std::array<std::uint8_t, 3> rgb{};
  std::uint8_t label = 0;      ///< class id of most of its pixels
  bool labelled = true;        ///< whether the class is known
  bool beside_moving = false;  ///< within ScanOptions::margin of it
};

/// OctoMap's keys of the voxels in a brick, shifted right by 3.
using BrickKey = std::array<std::uint16_t, 3>;

/// 8 × 8 × 8 voxels: an inner node of the octree, three levels above the leaves. Bit i of a set is
/// the voxel with the Morton code i, x in the lowest bit, so that the eight parts of every cube
/// follow each other.
struct ScanBrick {
  static constexpr int kEdge = 8;
  static constexpr int kVoxels = kEdge * kEdge * kEdge;
  using Voxels = std::array<std::uint64_t, kVoxels / 64>;

  BrickKey key{};
  Voxels hit{};
  Voxels passed{};                      ///< by a ray, and not hit
  std::int32_t sums = -1;               ///< of the scan under way
  std::uint32_t first_observation = 0;  ///< of its hit voxels, in those of the scan
};

struct ScanOptions {
  double resolution = 0.05;  ///< metres, edge of a voxel
  double range = 4.0;        ///< metres; farther, only free space is believed
  bool carve = true;         ///< whether rays are cast
  /// Free space ends so many standard deviations of the depth (Camera::surface_noise) before what
  /// was measured.
  double sigmas_before_surface = 0.0;
  /// Pixels of a lower map weight are no hits; the space in front of them is free nevertheless.
  std::uint8_t min_weight = 128;
  /// Voxels within this distance of such a pixel's voxel, in voxels, are beside something moving:
  /// the mask of a person may be a little too small. 0: none are.
  int margin = 0;
};

/// The scan of one key frame after the other; keeps its memory.
class ScanBricks {
 public:
  explicit ScanBricks(const ScanOptions& options);

  /// Replaces the scan before. The frame's images must have the camera's size.
  void scan(const DenseKeyFrame& keyframe);

  /// Sorted by the Morton code of their keys.
  std::span<const ScanBrick* const> bricks() const { return sorted_; }
  /// Of the hit voxels of a brick, in the order of their bits.
  const VoxelObservation* observations(const ScanBrick& brick) const {
    return observations_.data() + brick.first_observation;
  }

 private:
  // The rays of one row of the image.
  struct Row {
    std::vector<float> right;             // metres per metre of depth
    std::vector<float> reach;             // depth at which they end, metres
    std::vector<VoxelBits::Index> voxel;  // in which they end
    std::vector<VoxelBits::Index> front;  // before which they are believed
  };
  // Over the pixels of a voxel.
  struct Sum {
    std::uint16_t pixels = 0;
    std::array<std::uint16_t, 3> rgb{};
    MajorityVote label;
    bool beside_moving = false;

    void add(const std::uint8_t* bgr, std::uint8_t seen);
    VoxelObservation observation(bool labelled) const;
  };
  using Sums = std::array<Sum, ScanBrick::kVoxels>;

  void begin(const DenseKeyFrame& keyframe);
  void find_ends(const DenseKeyFrame& keyframe);
  void find_voxels(const Pose& world_from_camera, const Frame& frame, int v);
  Sum& sum_of(VoxelBits::Index voxel);
  ScanBrick& brick_at(int x, int y, int z);
  void mark_beside_moving();
  void add_passed();
  void finish();

  ScanOptions options_;
  int half_;                     // voxels, of the box around everything within range
  VoxelBits ended_;              // voxels before which a ray ends
  VoxelBits passed_;             // voxels through which a ray goes
  std::array<int, 3> corner_{};  // OctoMap's key of the box's first voxel
  Eigen::Vector3f origin_;       // camera, in voxels from the corner
  std::vector<VoxelBits::Index> ends_;
  std::vector<VoxelBits::Index> moving_;  // voxels in which pixels of a low map weight lie
  std::vector<std::int32_t> directory_;   // of the bricks of the box: index into bricks_, or -1
  std::vector<ScanBrick> bricks_;
  std::vector<Sums> sums_;
  bool labelled_ = false;  // whether the key frame is
  Row row_;
  std::vector<const ScanBrick*> sorted_;
  std::vector<VoxelObservation> observations_;
};

}  // namespace stillpoint::semantic_octree
