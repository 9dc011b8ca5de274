#include "map_octomap/map_files.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "stillpoint/atomic_file.hpp"
#include "stillpoint/point_cloud_file.hpp"

namespace stillpoint {
namespace {

// Leaves larger than a voxel are pruned ones: as many points as voxels.
template <typename Function>
void for_each_occupied_voxel(const SemanticOctree& tree, Function&& function) {
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const int edge = 1 << (tree.getTreeDepth() - leaf.getDepth());
    const double first = 0.5 * (1 - edge) * tree.getResolution();
    for (int i = 0; i < edge * edge * edge; ++i)
      function(
          leaf.getCoordinate() +
              octomap::point3d(static_cast<float>(first + i / edge / edge * tree.getResolution()),
                               static_cast<float>(first + i / edge % edge * tree.getResolution()),
                               static_cast<float>(first + i % edge * tree.getResolution())),
          *leaf);
  }
}

}  // namespace

void write_octree(const SemanticOctree& tree, const ClassNames& classes,
                  const std::filesystem::path& file) {
  AtomicFile out(file);
  tree.write(out.stream());
  nlohmann::json names = {{"names", classes}, {"colors", nlohmann::json::array()}};
  for (std::size_t label = 0; label < classes.size(); ++label)
    names["colors"].push_back(color_of_class(static_cast<std::uint8_t>(label)));
  std::string bytes = "# stillpoint classes 1\n" + names.dump() + '\n';
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    bytes.push_back(static_cast<char>(leaf->classes().best()));
    bytes.push_back(static_cast<char>(std::lround(255 * leaf->classes().confidence())));
  }
  out.stream() << bytes;
  out.commit();
}

void write_occupancy(const SemanticOctree& tree, const std::filesystem::path& file) {
  AtomicFile out(file);
  tree.writeBinaryConst(out.stream());
  out.commit();
}

void write_point_cloud(const SemanticOctree& tree, const ClassNames& classes,
                       const std::filesystem::path& file) {
  std::vector<LabelledPoint> points;
  for_each_occupied_voxel(tree, [&](const octomap::point3d& at, const SemanticVoxel& voxel) {
    const auto color = voxel.getColor();
    points.push_back({.position = {at.x(), at.y(), at.z()},
                      .rgb = {color.r, color.g, color.b},
                      .label = voxel.classes().best()});
  });
  write_ply(points, classes, file);
}

}  // namespace stillpoint
