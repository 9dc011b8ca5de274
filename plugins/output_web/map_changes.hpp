// What differs between two versions of the sparse map.
#pragma once

#include <stillpoint/sdk.hpp>

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {

/// Key frames, removed ones with the pose that they still stand for, and landmarks: those that are
/// not the same in both. Elements of a map never change, so equal pointers are equal elements.
void write_map_changes(const SparseMap& before, const SparseMap& after, MessageWriter& writer);

}  // namespace stillpoint::output_web
