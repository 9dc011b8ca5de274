// OctoMap's octree with a class in every voxel (DS-SLAM III-E).
#pragma once

#include <octomap/ColorOcTree.h>

#include <cstdint>
#include <span>
#include <string>

#include "semantic_octree/class_belief.hpp"
#include "semantic_octree/scan_bricks.hpp"

namespace stillpoint::semantic_octree {

/// Log-odds of one scan, and their limits.
struct OccupancyModel {
  float hit = 0.85F;
  float miss = -0.4F;  ///< 0: free space is not carved (the paper)
  float min = -2.0F;   ///< clamped, so that things may appear …
  float max = 3.5F;    ///< … and disappear again
  /// Initial log-odds of a voxel whose first hit is beside something moving.
  float doubt = 0.0F;
};

/// Occupancy in log-odds, mean colour and class of a leaf; an inner node has the occupancy of its
/// most occupied child and, of its occupied children, the mean colour.
class SemanticVoxel : public octomap::ColorOcTreeNode {
 public:
  void copyData(const SemanticVoxel& from) {
    octomap::ColorOcTreeNode::copyData(from);
    colors_ = from.colors_;
    classes_ = from.classes_;
  }
  bool operator==(const SemanticVoxel& other) const {
    return octomap::ColorOcTreeNode::operator==(other) && classes_ == other.classes_;
  }

  const ClassBelief& classes() const { return classes_; }
  void set_classes(const ClassBelief& classes) { classes_ = classes; }

  /// `known`: whether anything was before.
  void hit(const VoxelObservation& observation, bool known, const OccupancyModel& model);
  void pass(const OccupancyModel& model);
  /// Of an inner node, after its children have changed.
  void summarise_children();
  /// After all of them have been deleted.
  void free_children();

 private:
  std::uint8_t colors_ = 0;  // that the mean is of, at most kMostColors
  ClassBelief classes_;
};

/// The file type is that of octomap::ColorOcTree, which reads and shows it.
class SemanticOctree : public octomap::OccupancyOcTreeBase<SemanticVoxel> {
 public:
  /// `edge` of a voxel in metres.
  explicit SemanticOctree(double edge) : octomap::OccupancyOcTreeBase<SemanticVoxel>(edge) {}

  SemanticOctree* create() const override { return new SemanticOctree(resolution); }
  std::string getTreeType() const override { return "ColorOcTree"; }

  /// Adds a scan made at this tree's resolution: what it hit becomes more, what it passed less
  /// occupied. The same as OctoMap's insertPointCloud() with discretised points, but whole cubes of
  /// free space at once; uniform parts are pruned on the way. `bricks` are some of the scan's, in
  /// their order.
  void add(const ScanBricks& scan, std::span<const ScanBrick* const> bricks,
           const OccupancyModel& model);
  /// Whether something is known to be there.
  bool is_occupied(const octomap::OcTreeKey& key) const {
    const SemanticVoxel* voxel = search(key);
    return voxel && isNodeOccupied(voxel);
  }
  /// The root, made when there is none.
  SemanticVoxel& create_root();
  /// Forgets all that is known within some bricks.
  void remove(std::span<const BrickKey> bricks);

 private:
  class Addition;

  bool remove_brick(SemanticVoxel& node, unsigned depth, const BrickKey& key);
  void remove_children(SemanticVoxel& node);
};

}  // namespace stillpoint::semantic_octree
