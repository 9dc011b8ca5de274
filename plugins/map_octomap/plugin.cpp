#include "map_octomap/octomap_backend.hpp"

STILLPOINT_PLUGIN(
    map_octomap, "0.1.0",
    stillpoint::provide<stillpoint::MapBackend, stillpoint::map_octomap::OctomapBackend>(
        "octomap", "dense semantic octree, corrected when key frames move (OctoMap)"));
