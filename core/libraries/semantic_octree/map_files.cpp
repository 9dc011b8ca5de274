#include "semantic_octree/map_files.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/point_cloud_file.hpp"

namespace stillpoint::semantic_octree {

namespace {

// OctoMap's own functions print a line whenever they have written one.
void write_header(const SemanticOctree& tree, const char* first_line, std::ostream& out) {
  out << first_line << "\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
      << tree.getResolution() << "\ndata\n";
}

}  // namespace

MapClasses with_colors(const ClassNames& names) {
  MapClasses classes{.names = names, .colors = {}};
  for (std::size_t label = 0; label < names.size(); ++label)
    classes.colors.push_back(color_of_class(static_cast<std::uint8_t>(label)));
  return classes;
}

void write_octree(const SemanticOctree& tree, const MapClasses& classes,
                  const std::filesystem::path& file) {
  AtomicFile out(file);
  write_header(tree, "# Octomap OcTree file", out.stream());
  tree.writeData(out.stream());
  const nlohmann::json description = {{"names", classes.names},
                                      {"colors", classes.colors},
                                      {"occupied_above", tree.getOccupancyThres()}};
  std::string bytes = "# stillpoint classes 1\n" + description.dump() + '\n';
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    bytes.push_back(static_cast<char>(leaf->classes().best()));
    bytes.push_back(static_cast<char>(std::lround(255 * leaf->classes().confidence())));
  }
  out.stream() << bytes;
  out.commit();
}

void write_occupancy(const SemanticOctree& tree, const std::filesystem::path& file) {
  AtomicFile out(file);
  write_header(tree, "# Octomap OcTree binary file", out.stream());
  tree.writeBinaryData(out.stream());
  out.commit();
}

std::vector<LabelledPoint> occupied_points(const SemanticOctree& tree) {
  std::vector<LabelledPoint> points;
  for_each_occupied_voxel(tree, [&](const Eigen::Vector3d& at, const SemanticVoxel& voxel) {
    const auto color = voxel.getColor();
    points.push_back({.position = at.cast<float>(),
                      .rgb = {color.r, color.g, color.b},
                      .label = voxel.classes().best(),
                      .occupancy = static_cast<float>(voxel.getOccupancy())});
  });
  return points;
}

void write_point_cloud(const SemanticOctree& tree, const MapClasses& classes,
                       const std::filesystem::path& file) {
  write_ply(occupied_points(tree), classes.names, file);
}

}  // namespace stillpoint::semantic_octree
