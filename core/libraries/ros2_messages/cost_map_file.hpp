// The cost map beside a dense map, map.pgm and map.yaml, in the format of ROS's map_server.
#pragma once

#include <filesystem>
#include <optional>

#include "ros2_messages/messages.hpp"

namespace stillpoint::ros2_messages {

/// In Stillpoint's world, without a header. Nothing when the folder is empty or holds no cost map,
/// which is so where no floor was found. Throws Error(kData) for files that are none.
std::optional<OccupancyGrid> read_cost_map(const std::filesystem::path& folder);

}  // namespace stillpoint::ros2_messages
