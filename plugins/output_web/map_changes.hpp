// What differs between two versions of the sparse map.
#pragma once

#include <cstddef>
#include <memory>
#include <stillpoint/sdk.hpp>

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {

using MapPtr = std::shared_ptr<const SparseMap>;

/// What a viewer has of the sparse map.
struct SeenMap {
  MapPtr whole = std::make_shared<const SparseMap>();
  MapPtr next;               ///< a later version, of which it has a part; null: none
  KeyFrameId keyframes = 0;  ///< those before this one are as in `next`
  LandmarkId landmarks = 0;  ///< likewise
};

/// Key frames, removed ones with the pose that they still stand for, and landmarks: those that are
/// not the same in both versions. Elements of a map never change, so equal pointers are equal
/// elements. Ends with the first element beyond `limit` bytes: the rest comes with the next calls,
/// and a version that has been begun is finished before `now` is.
void write_map_changes(SeenMap& seen, const MapPtr& now, std::size_t limit, MessageWriter& writer);

}  // namespace stillpoint::output_web
