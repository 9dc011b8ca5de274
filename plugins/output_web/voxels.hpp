// The dense map for viewers, and what differs between two states of it.
#pragma once

#include <cstddef>
#include <memory>
#include <stillpoint/sdk.hpp>
#include <vector>

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {

/// Sorted by position.
using Voxels = std::vector<LabelledPoint>;
using VoxelsPtr = std::shared_ptr<const Voxels>;

VoxelsPtr sorted_voxels(std::vector<LabelledPoint> points);

/// Whether no viewer could see a difference.
bool look_alike(const Voxels& a, const Voxels& b);

/// Writes at most `limit` of the changes that turn `before` into `after`. Gives what the viewer has
/// then.
VoxelsPtr write_voxel_changes(const VoxelsPtr& before, const VoxelsPtr& after, std::size_t limit,
                              MessageWriter& writer);

}  // namespace stillpoint::output_web
