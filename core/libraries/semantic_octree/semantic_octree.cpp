#include "semantic_octree/semantic_octree.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace stillpoint::semantic_octree {
namespace {

constexpr unsigned kBrickDepth = 13;      // of 16: its voxels are three levels below
constexpr std::uint8_t kMostColors = 20;  // afterwards, old ones fade

/// Of `kCount` voxels from `first` on.
template <int kCount>
bool any(const ScanBrick::Voxels& voxels, unsigned first) {
  if constexpr (kCount == ScanBrick::kVoxels)
    return std::any_of(voxels.begin(), voxels.end(), [](std::uint64_t word) { return word != 0; });
  else
    return voxels[first / 64] >> (first % 64) & (~std::uint64_t{0} >> (64 - kCount));
}

template <int kCount>
bool all(const ScanBrick::Voxels& voxels, unsigned first) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0} >> (kCount >= 64 ? 0 : 64 - kCount);
  if constexpr (kCount == ScanBrick::kVoxels)
    return std::all_of(voxels.begin(), voxels.end(),
                       [](std::uint64_t word) { return word == kAll; });
  else
    return (voxels[first / 64] >> (first % 64) & kAll) == kAll;
}

// Of a node at `depth`: in which of its children a brick lies.
unsigned octant_of(const BrickKey& key, unsigned depth) {
  const unsigned bit = kBrickDepth - 1 - depth;
  return (key[0] >> bit & 1U) | (key[1] >> bit & 1U) << 1U | (key[2] >> bit & 1U) << 2U;
}

}  // namespace

void SemanticVoxel::hit(const VoxelObservation& observation, bool known,
                        const OccupancyModel& model) {
  if (!known && observation.beside_moving) value = model.doubt;
  value = std::min(value + model.hit, model.max);
  colors_ = static_cast<std::uint8_t>(std::min(colors_ + 1, int{kMostColors}));
  const auto mean = [&](int old, int seen) {
    return static_cast<std::uint8_t>((old * (colors_ - 1) + seen + colors_ / 2) / colors_);
  };
  color = Color(mean(color.r, observation.rgb[0]), mean(color.g, observation.rgb[1]),
                mean(color.b, observation.rgb[2]));
  if (observation.labelled) classes_.add(observation.label);
}

// At the lower clamping bound, colour and class are reset: the surface is gone.
void SemanticVoxel::pass(const OccupancyModel& model) {
  value = std::max(value + model.miss, model.min);
  if (value > model.min) return;
  color = Color();
  colors_ = 0;
  classes_ = {};
}

void SemanticVoxel::summarise_children() {
  int count = 0, r = 0, g = 0, b = 0;
  value = std::numeric_limits<float>::lowest();
  for (int i = 0; i < 8; ++i) {
    const auto* child = static_cast<const SemanticVoxel*>(children[i]);
    if (!child) continue;
    value = std::max(value, child->value);
    if (!child->isColorSet()) continue;
    ++count;
    r += child->color.r;
    g += child->color.g;
    b += child->color.b;
  }
  const auto mean = [&](int sum) { return static_cast<std::uint8_t>(sum / count); };
  color = count > 0 ? Color(mean(r), mean(g), mean(b)) : Color();
}

void SemanticVoxel::free_children() {
  delete[] children;
  children = nullptr;
}

/// Of one scan to one tree: down from the root, several bricks at once, then within each brick by
/// ranges of its Morton codes.
class SemanticOctree::Addition {
 public:
  Addition(SemanticOctree& tree, const ScanBricks& scan, const OccupancyModel& model)
      : tree_(tree), scan_(scan), model_(model) {}

  /// All of them lie within the node. `known` says whether anything is known of the node: one
  /// without children then stands for all below it.
  void add(SemanticVoxel& node, bool known, unsigned depth,
           std::span<const ScanBrick* const> bricks) {
    if (depth == kBrickDepth) {
      observation_ = scan_.observations(*bricks.front());
      add_voxels<ScanBrick::kVoxels>(node, known, *bricks.front(), 0);
      return;
    }
    divide(node, known);
    while (!bricks.empty()) {
      const unsigned octant = octant_of(bricks.front()->key, depth);
      const auto others = std::find_if(bricks.begin(), bricks.end(), [&](const ScanBrick* brick) {
        return octant_of(brick->key, depth) != octant;
      });
      const auto count = static_cast<std::size_t>(others - bricks.begin());
      const bool child_known = tree_.nodeChildExists(&node, octant);
      add(child(node, octant), child_known, depth + 1, bricks.first(count));
      bricks = bricks.subspan(count);
    }
    finish(node);
  }

 private:
  template <int kCount>
  void add_voxels(SemanticVoxel& node, bool known, const ScanBrick& brick, unsigned first) {
    const bool uniform = !tree_.nodeHasChildren(&node);
    if constexpr (kCount == 1) {
      if (any<1>(brick.hit, first))
        node.hit(*observation_++, known, model_);
      else
        node.pass(model_);
    } else if (uniform && all<kCount>(brick.passed, first)) {
      node.pass(model_);
    } else {
      divide(node, known);
      constexpr int kPart = kCount / 8;
      for (unsigned octant = 0; octant < 8; ++octant) {
        const unsigned begin = first + octant * kPart;
        if (!any<kPart>(brick.hit, begin) && !any<kPart>(brick.passed, begin)) continue;
        const bool child_known = tree_.nodeChildExists(&node, octant);
        add_voxels<kPart>(child(node, octant), child_known, brick, begin);
      }
      finish(node);
    }
  }

  void divide(SemanticVoxel& node, bool known) {
    if (known && !tree_.nodeHasChildren(&node)) tree_.expandNode(&node);
  }

  SemanticVoxel& child(SemanticVoxel& node, unsigned octant) {
    return tree_.nodeChildExists(&node, octant) ? *tree_.getNodeChild(&node, octant)
                                                : *tree_.createNodeChild(&node, octant);
  }

  void finish(SemanticVoxel& node) {
    if (!tree_.pruneNode(&node)) node.summarise_children();
  }

  SemanticOctree& tree_;
  const ScanBricks& scan_;
  const OccupancyModel& model_;
  const VoxelObservation* observation_ = nullptr;  // of the next voxel that was hit
};

void SemanticOctree::add(const ScanBricks& scan, std::span<const ScanBrick* const> bricks,
                         const OccupancyModel& model) {
  if (bricks.empty()) return;
  const bool known = root != nullptr;
  Addition(*this, scan, model).add(create_root(), known, 0, bricks);
}

SemanticVoxel& SemanticOctree::create_root() {
  if (!root) {
    root = new SemanticVoxel;
    ++tree_size;
  }
  return *root;
}

void SemanticOctree::remove(std::span<const BrickKey> bricks) {
  for (const BrickKey& key : bricks)
    if (root && remove_brick(*root, 0, key)) clear();
}

// Whether nothing is left of the node, which is for the caller to remove. OctoMap's deleteNode()
// removes leaves only.
bool SemanticOctree::remove_brick(SemanticVoxel& node, unsigned depth, const BrickKey& key) {
  if (depth == kBrickDepth) {
    remove_children(node);
    return true;
  }
  const unsigned octant = octant_of(key, depth);
  if (!nodeHasChildren(&node)) expandNode(&node);
  if (!nodeChildExists(&node, octant)) return false;
  if (remove_brick(*getNodeChild(&node, octant), depth + 1, key)) {
    deleteNodeChild(&node, octant);
    if (!nodeHasChildren(&node)) {
      node.free_children();
      return true;
    }
  }
  node.summarise_children();
  return false;
}

void SemanticOctree::remove_children(SemanticVoxel& node) {
  for (unsigned i = 0; i < 8; ++i) {
    if (!nodeChildExists(&node, i)) continue;
    remove_children(*getNodeChild(&node, i));
    deleteNodeChild(&node, i);
  }
  node.free_children();
}

}  // namespace stillpoint::semantic_octree
