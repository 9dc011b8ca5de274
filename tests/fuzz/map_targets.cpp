// Saved maps: the sparse one, and the octree.
#include <memory>

#include "fuzz/fuzz_target.hpp"
#include "semantic_octree/octree_reader.hpp"
#include "semantic_octree/test_map.hpp"
#include "stillpoint/engine/map_file.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::testing {
namespace {

using semantic_octree::read_octree;
using semantic_octree::TestMap;

FuzzTarget octree() {
  const TemporaryFolder folder;
  TestMap({}, {.resolution = 0.4}).save(folder.path());
  return {.seeds = {bytes_of(folder.path() / "map.ot"), bytes_of(folder.path() / "map.bt")},
          .parse = [](const fs::path& file) { read_octree(file); },
          .words = {"# Octomap OcTree file\n", "# Octomap OcTree binary file\n", "id OcTree\n",
                    "id ColorOcTree\n", "size 99999999\n", "res 0.05\n", "data\n",
                    "# stillpoint classes 1\n", "occupied_above"}};
}

FuzzTarget saved_map() {
  const TemporaryFolder folder;
  MapEdit map{SparseMap()};
  KeyFrame keyframe{.id = 0, .camera = std::make_shared<const Camera>()};
  keyframe.features = std::make_shared<const Features>(
      Features{.keypoints = {{}}, .descriptors = {{}}, .depth = {1}});
  keyframe.track_weights = keyframe.map_weights = {255};
  keyframe.landmarks = {kNoId};
  map.add_keyframe(std::move(keyframe));
  const LandmarkId landmark = map.add_landmark({.reference = 0});
  map.add_observation(landmark, {.keyframe = 0, .feature = 0});
  save_map(map.map(), folder.path() / "map.stillpoint");
  return {.seeds = {bytes_of(folder.path() / "map.stillpoint")},
          .parse = [](const fs::path& file) { load_map(file); },
          .words = {"CREATE TABLE", "CREATE VIEW", "CREATE TRIGGER", "keyframe"}};
}

}  // namespace

std::vector<NamedFuzzTarget> map_targets() { return {{"Octree", octree}, {"SavedMap", saved_map}}; }

}  // namespace stillpoint::testing
