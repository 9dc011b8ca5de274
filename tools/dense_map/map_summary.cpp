#include "dense_map/map_summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "dense_map/text.hpp"

namespace stillpoint::dense_map {
namespace {

using semantic_octree::floor_of;
using semantic_octree::for_each_occupied_voxel;
using semantic_octree::SemanticOctree;
using semantic_octree::SemanticVoxel;

// 1,234,567.
std::string grouped(std::size_t number) {
  std::string digits = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), ",");
  return digits;
}

std::string row(const std::string& name, const std::string& value) {
  return "  " + name + std::string(14 - name.size(), ' ') + value + '\n';
}

std::string floor_text(const std::optional<FloorPlane>& floor) {
  if (!floor) return "not found";
  return text("%.2f m %s the origin, up is (%.3f, %.3f, %.3f)", std::abs(floor->height),
              floor->height > 0 ? "above" : "below", floor->up.x(), floor->up.y(), floor->up.z());
}

}  // namespace

MapSummary summarise(const SavedOctree& map, const CostMapOptions& options) {
  const SemanticOctree& tree = *map.tree;
  MapSummary summary{.resolution = tree.getResolution(),
                     .nodes = tree.size(),
                     .memory = tree.memoryUsage(),
                     .has_colors = map.has_colors,
                     .floor = floor_of(tree, options)};
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const auto voxels = std::size_t{1} << (3 * (tree.getTreeDepth() - leaf.getDepth()));
    (tree.isNodeOccupied(*leaf) ? summary.occupied : summary.free) += voxels;
  }
  std::array<ClassShare, 256> shares;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector3d high = -low;
  for_each_occupied_voxel(tree, [&](const Eigen::Vector3d& at, const SemanticVoxel& voxel) {
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
    ClassShare& share = shares[voxel.classes().best()];
    ++share.voxels;
    share.confidence += voxel.classes().confidence();
  });
  if (summary.occupied > 0) {
    summary.low = low.array() - 0.5 * summary.resolution;
    summary.high = high.array() + 0.5 * summary.resolution;
  }
  for (std::size_t label = 0; label < map.classes.names.size() && label < shares.size(); ++label) {
    ClassShare& share = shares[label];
    if (share.voxels == 0) continue;
    share.name = map.classes.names[label];
    share.confidence /= static_cast<double>(share.voxels);
    summary.classes.push_back(share);
  }
  std::ranges::stable_sort(summary.classes, std::greater{}, &ClassShare::voxels);
  return summary;
}

std::string summary_table(const MapSummary& s, const std::string& name) {
  const Eigen::Vector3d size = s.high - s.low;
  const double volume = s.resolution * s.resolution * s.resolution;
  std::string out = name + '\n';
  out += row("voxels", text("%g cm, ", 100 * s.resolution) +
                           (s.classes.empty() ? s.has_colors ? "colours" : "occupancy only"
                                              : "colours and classes"));
  out += row("size", text("%.2f x %.2f x %.2f m (world x, y, z)", size.x(), size.y(), size.z()));
  out += row("occupied", grouped(s.occupied) + text(" voxels, %.1f m2 of surface", s.surface()));
  out +=
      row("free", grouped(s.free) + text(" voxels, %.1f m3", static_cast<double>(s.free) * volume));
  out += row("floor", floor_text(s.floor));
  out += row("memory",
             text("%.1f MiB, %.0f kB per m2 of surface", static_cast<double>(s.memory) / (1 << 20),
                  s.occupied > 0 ? static_cast<double>(s.memory) / 1e3 / s.surface() : 0.0));
  if (s.classes.empty()) return out;
  out += "  class             voxels   share  certain\n";
  for (const ClassShare& c : s.classes)
    out += text("  %-14.14s %9s  %5.1f %%    %3.0f %%\n", c.name.c_str(), grouped(c.voxels).c_str(),
                100.0 * static_cast<double>(c.voxels) / static_cast<double>(s.occupied),
                100 * c.confidence);
  return out;
}

nlohmann::json summary_json(const MapSummary& s) {
  const auto array = [](const Eigen::Vector3d& v) { return std::array{v.x(), v.y(), v.z()}; };
  nlohmann::json json = {{"resolution_m", s.resolution},
                         {"occupied_voxels", s.occupied},
                         {"free_voxels", s.free},
                         {"surface_m2", s.surface()},
                         {"nodes", s.nodes},
                         {"memory_bytes", s.memory},
                         {"low_m", array(s.low)},
                         {"high_m", array(s.high)},
                         {"has_colors", s.has_colors},
                         {"floor", nullptr},
                         {"classes", nlohmann::json::array()}};
  if (s.floor) json["floor"] = {{"up", array(s.floor->up)}, {"height_m", s.floor->height}};
  for (const ClassShare& c : s.classes)
    json["classes"].push_back(
        {{"name", c.name}, {"voxels", c.voxels}, {"confidence", c.confidence}});
  return json;
}

}  // namespace stillpoint::dense_map
