#include "map_octomap/map_files.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "stillpoint/atomic_file.hpp"

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

template <typename Value>
void put(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::array<std::uint8_t, 3> color_of_class(std::uint8_t label) {
  std::array<std::uint8_t, 3> rgb{};
  for (unsigned bit = 0; bit < 8; ++bit)
    rgb[bit % 3] = static_cast<std::uint8_t>(rgb[bit % 3] | (label >> bit & 1U) << (7 - bit / 3));
  return rgb;
}

void write_octree(const SemanticOctree& tree, const ClassNames& classes,
                  const std::filesystem::path& file) {
  AtomicFile out(file);
  tree.write(out.stream());
  nlohmann::json names = {{"names", classes}, {"colors", nlohmann::json::array()}};
  for (std::size_t label = 0; label < classes.size(); ++label)
    names["colors"].push_back(color_of_class(static_cast<std::uint8_t>(label)));
  std::string bytes = "# stillpoint classes 1\n" + names.dump() + '\n';
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    put(bytes, leaf->classes().best());
    put(bytes, static_cast<std::uint8_t>(std::lround(255 * leaf->classes().confidence())));
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
  std::string points;
  std::size_t count = 0;
  for_each_occupied_voxel(tree, [&](const octomap::point3d& at, const SemanticVoxel& voxel) {
    ++count;
    for (unsigned axis = 0; axis < 3; ++axis) put(points, at(axis));
    put(points, voxel.getColor().r);
    put(points, voxel.getColor().g);
    put(points, voxel.getColor().b);
    put(points, voxel.classes().best());
  });
  AtomicFile out(file);
  out.stream() << "ply\nformat binary_little_endian 1.0\n";
  for (std::size_t label = 0; label < classes.size(); ++label)
    out.stream() << "comment label " << label << ' ' << classes[label] << '\n';
  out.stream() << "element vertex " << count
               << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                  "property uchar green\nproperty uchar blue\nproperty uchar label\nend_header\n"
               << points;
  out.commit();
}

}  // namespace stillpoint
