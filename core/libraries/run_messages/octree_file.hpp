// The octree beside a dense map, map.bt, in OctoMap's binary format.
#pragma once

#include <filesystem>
#include <optional>

#include "mcap_writer/messages.hpp"

namespace stillpoint::run_messages {

/// Without a header; its axes are those of Stillpoint's world. Nothing when the folder is empty or
/// holds no octree. Throws Error(kData) for a file that is none.
std::optional<mcap_writer::Octree> read_octree_message(const std::filesystem::path& folder);

}  // namespace stillpoint::run_messages
