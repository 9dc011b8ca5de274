// A map of the test room, made and saved as the back end does it.
#pragma once

#include <cmath>
#include <filesystem>

#include "semantic_octree/cost_map.hpp"
#include "semantic_octree/map_files.hpp"
#include "semantic_octree/semantic_octree.hpp"
#include "semantic_octree/test_room.hpp"

namespace stillpoint::semantic_octree {

struct TestMapOptions {
  double resolution = 0.05;     ///< metres
  double occupied_above = 0.5;  ///< probability
  bool carve = true;            ///< free space
};

/// All around from the middle of the room, level and down to the floor.
class TestMap {
 public:
  explicit TestMap(const TestRoom& room, const TestMapOptions& options = {})
      : tree_(options.resolution) {
    const auto log_odds = [](double p) { return static_cast<float>(std::log(p / (1 - p))); };
    const OccupancyModel model{.hit = log_odds(0.65),
                               .miss = options.carve ? log_odds(0.3) : 0.0F,
                               .min = log_odds(0.12),
                               .max = log_odds(0.97)};
    tree_.setOccupancyThres(options.occupied_above);
    ScanBricks scan(
        {.resolution = options.resolution, .carve = options.carve, .sigmas_before_surface = 2.0});
    for (KeyFrameId id = 0; id < 24; ++id) {
      Pose pose = looking({0.1, -0.4, 1.31}, 0.55 * id);
      if (id % 2 == 1) pose.rotate(Eigen::AngleAxisd(-0.8, Eigen::Vector3d::UnitX()));
      scan.scan(room.render(pose, id));
      tree_.add(scan, scan.bricks(), model);
    }
  }

  const SemanticOctree& tree() const { return tree_; }

  void save(const std::filesystem::path& folder) const {
    const MapClasses classes = with_colors(named_classes("voc21"));
    write_octree(tree_, classes, folder / "map.ot");
    write_occupancy(tree_, folder / "map.bt");
    write_point_cloud(tree_, classes, folder / "map.ply");
    const CostMapOptions options;
    if (const auto floor = floor_of(tree_, options))
      write_cost_map(project(tree_, *floor, options), folder / "map");
  }

 private:
  SemanticOctree tree_;
};

}  // namespace stillpoint::semantic_octree
