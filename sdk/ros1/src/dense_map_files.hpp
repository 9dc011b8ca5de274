// The files of a dense map (docs/dense_maps.md) as messages; headers are the caller's to fill in.
#pragma once

#include <nav_msgs/OccupancyGrid.h>
#include <octomap_msgs/Octomap.h>

#include <filesystem>
#include <stillpoint/pose_math.hpp>

namespace stillpoint_ros {

/// Of `map.bt`, in the engine's world. Throws stillpoint::Error(kData) for a file that is none.
octomap_msgs::Octomap octomap_message(const std::filesystem::path& file);

/// Of `map.yaml` and the image it names: 100 occupied, 0 free, -1 unknown. Its origin, with a
/// rotation, is in the map. Throws stillpoint::Error(kData) for files that are none.
nav_msgs::OccupancyGrid grid_message(const std::filesystem::path& description,
                                     const stillpoint::Pose& map_from_world);

}  // namespace stillpoint_ros
