// The octree beside a dense map, map.bt, in OctoMap's binary format.
#pragma once

#include <filesystem>
#include <optional>

#include "ros2_messages/messages.hpp"

namespace stillpoint::ros2_messages {

/// Without a header; its axes are those of Stillpoint's world. Nothing when the folder is empty or
/// holds no octree. Throws Error(kData) for a file that is none.
std::optional<Octree> read_octree_message(const std::filesystem::path& folder);

}  // namespace stillpoint::ros2_messages
