// Map back end `octomap`: the dense semantic octree (DS-SLAM III-E), corrected with its key frames.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "map_octomap/stored_keyframe.hpp"
#include "semantic_octree/cost_map.hpp"
#include "semantic_octree/map_files.hpp"
#include "semantic_octree/scan_bricks.hpp"
#include "semantic_octree/semantic_octree.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::map_octomap {

using semantic_octree::BrickKey;
using semantic_octree::CostMapOptions;
using semantic_octree::MapClasses;
using semantic_octree::OccupancyModel;
using semantic_octree::occupied_points;
using semantic_octree::ScanBricks;
using semantic_octree::SemanticOctree;

/// The map is a function of its key frames, their poses and their order: where some have moved, all
/// that was ever seen there is fused again, and the rest stays as it is.
class OctomapBackend final : public MapBackend {
 public:
  /// Free space ends this many standard deviations of the depth before a ray's end. At 2 cm more
  /// voxels of surfaces would be carved away than noise leaves in free space (docs/dense_maps.md).
  static constexpr double kSigmasBeforeSurface = 2.0;
  /// Most scans for fusing again per new key frame, on average: where poses never settle, the time
  /// would otherwise grow with the square of the number of key frames.
  static constexpr std::size_t kScansPerKeyFrame = 10;

  struct Options {
    enum class Model {
      kRays,  ///< free space is carved along every ray
      kHits   ///< the paper's eq. 6: only what is seen to be occupied counts
    };
    double resolution = 0.05;  ///< metres
    double range = 4.0;        ///< metres
    Model model = Model::kRays;
    double prob_hit = 0.65;       ///< probability that a voxel is occupied when it is hit
    double prob_miss = 0.3;       ///< likewise, when a ray passes it
    double clamping_min = 0.12;   ///< clamping bounds, so that objects may disappear
    double clamping_max = 0.97;   ///< and appear again
    double occupied_above = 0.5;  ///< probability
    double tolerance = 0.5;       ///< voxels that key frames may move before they are fused again
    int stride = 0;               ///< px; 0 = by resolution and range
    int min_weight = 128;         ///< of StaticWeights::map
    /// Metres around pixels of less weight in which a voxel needs two hits; in whole voxels, at
    /// most three.
    double margin = 0.05;
    CostMapOptions cost_map;

    void visit(OptionVisitor& visitor);
  };

  OctomapBackend(const Options& options, const StageContext& context);

  /// Throws Error(kData) for a pose that is out of the octree's reach.
  void integrate(const DenseKeyFrame& keyframe) override;
  void move(std::span<const MovedKeyFrame> moved) override;
  void clear() override;
  void save(const std::filesystem::path& directory) override;
  std::vector<LabelledPoint> occupied() const override { return occupied_points(tree_); }

  const SemanticOctree& tree() const { return tree_; }

 private:
  struct Entry {
    StoredKeyFrame images;
    Pose world_from_camera = Pose::Identity();  // as it is now
    Pose fused_at = Pose::Identity();
    std::vector<BrickKey> bricks;  // that it has seen, sorted
  };

  int stride_for(const Camera& camera) const;
  void scan(Entry& entry);
  static bool is_up_to_date(const Entry& entry);
  double moved_by(const Entry& entry) const;
  /// Returns the number of scans.
  std::size_t fuse_again(std::span<const std::size_t> entries);
  void save_cost_map(const std::filesystem::path& directory);
  void warn_once(const std::string& what);

  Options options_;
  std::function<void(LogLevel, std::string_view)> log_;
  std::set<std::string> warned_;
  MapClasses classes_;
  OccupancyModel model_;
  SemanticOctree tree_;
  ScanBricks scan_;
  std::vector<Entry> entries_;  // in the order in which they came
  std::map<KeyFrameId, std::size_t> index_;
  std::size_t rest_until_ = 0;  // entries, before which nothing is fused again but by save()
};

}  // namespace stillpoint::map_octomap
