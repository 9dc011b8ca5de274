#include "dense_map/map_difference.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "dense_map/text.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::dense_map {
namespace {

using semantic_octree::for_each_occupied_voxel;
using semantic_octree::MapClasses;
using semantic_octree::SemanticOctree;
using semantic_octree::SemanticVoxel;

bool is_near(const SemanticOctree& tree, const octomap::OcTreeKey& key) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (tree.is_occupied(octomap::OcTreeKey(static_cast<octomap::key_type>(key[0] + x),
                                                static_cast<octomap::key_type>(key[1] + y),
                                                static_cast<octomap::key_type>(key[2] + z))))
          return true;
  return false;
}

std::string name_of(const MapClasses& classes, const SemanticVoxel& voxel) {
  const std::size_t label = voxel.classes().best();
  return label < classes.names.size() ? classes.names[label] : std::string();
}

// What `map` has and `other` lacks.
struct Lacking {
  std::size_t count = 0, near = 0, free = 0;
};

template <typename Shared>
Lacking compare_one_way(const SavedOctree& map, const SavedOctree& other, LabelledPoint look,
                        std::vector<LabelledPoint>& points, Shared&& shared) {
  Lacking lacking;
  for_each_occupied_voxel(*map.tree, [&](const Eigen::Vector3d& at, const SemanticVoxel& voxel) {
    const octomap::OcTreeKey key = other.tree->coordToKey(at.x(), at.y(), at.z());
    const SemanticVoxel* there = other.tree->search(key);
    if (there && other.tree->isNodeOccupied(there)) {
      shared(voxel, *there);
      return;
    }
    ++lacking.count;
    lacking.near += is_near(*other.tree, key);
    lacking.free += there != nullptr;
    look.position = at.cast<float>();
    points.push_back(look);
  });
  return lacking;
}

}  // namespace

double MapDifference::overlap() const {
  const std::size_t any = both + only_first + only_second;
  return any > 0 ? static_cast<double>(both) / static_cast<double>(any) : 1.0;
}

MapDifference compare(const SavedOctree& first, const SavedOctree& second) {
  const double a = first.tree->getResolution(), b = second.tree->getResolution();
  if (std::abs(a - b) > 1e-6 * a)
    throw Error(Fault::kUsage,
                text("voxels of %g and of %g cm cannot be compared", 100 * a, 100 * b), {},
                "make both maps with the same resolution");
  MapDifference d;
  d.classes = !first.classes.names.empty() && !second.classes.names.empty();
  const Lacking gone = compare_one_way(
      first, second, {.position = {}, .rgb = {220, 50, 47}, .label = 1}, d.points,
      [&](const SemanticVoxel& one, const SemanticVoxel& other) {
        ++d.both;
        d.other_class += d.classes && name_of(first.classes, one) != name_of(second.classes, other);
      });
  const Lacking come =
      compare_one_way(second, first, {.position = {}, .rgb = {40, 160, 60}, .label = 2}, d.points,
                      [](const SemanticVoxel&, const SemanticVoxel&) {});
  d.only_first = gone.count;
  d.near_second = gone.near;
  d.gone = gone.free;
  d.only_second = come.count;
  d.near_first = come.near;
  d.appeared = come.free;
  return d;
}

std::string difference_table(const MapDifference& d, const std::string& first,
                             const std::string& second) {
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  std::string out = "first   " + first + "\nsecond  " + second + '\n';
  out += text("  occupied in both   %9zu voxels, %.2f %% of all occupied ones\n", d.both,
              100 * d.overlap());
  out += text("  only in the first  %9zu: %zu beside a voxel of the second, %zu free there\n",
              d.only_first, d.near_second, d.gone);
  out += text("  only in the second %9zu: %zu beside a voxel of the first, %zu free there\n",
              d.only_second, d.near_first, d.appeared);
  if (d.classes)
    out += text("  of another class   %9zu, %.2f %% of those in both\n", d.other_class,
                share(d.other_class, d.both));
  return out;
}

nlohmann::json difference_json(const MapDifference& d) {
  nlohmann::json json = {{"both", d.both},
                         {"only_first", d.only_first},
                         {"only_first_near_second", d.near_second},
                         {"only_first_free_in_second", d.gone},
                         {"only_second", d.only_second},
                         {"only_second_near_first", d.near_first},
                         {"only_second_free_in_first", d.appeared},
                         {"overlap", d.overlap()},
                         {"other_class", nullptr}};
  if (d.classes) json["other_class"] = d.other_class;
  return json;
}

}  // namespace stillpoint::dense_map
