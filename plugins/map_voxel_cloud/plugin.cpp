#include "map_voxel_cloud/voxel_cloud_backend.hpp"

STILLPOINT_PLUGIN(
    map_voxel_cloud, "0.1.0",
    stillpoint::provide<stillpoint::MapBackend, stillpoint::map_voxel_cloud::VoxelCloudBackend>(
        "voxel_cloud", "coloured and labelled point cloud, for previews"));
