// Contract: extends and refines the sparse map (paper III-A). Thread 3, the map's only writer.
#pragma once

#include <cstdint>
#include <stop_token>

#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Two steps, each published on its own: tracking gets new landmarks after the quick first one and
/// does not wait for the bundle adjustment of the second.
class STILLPOINT_EXPORT LocalMapper {
 public:
  static constexpr const char* kKind = "local_mapper";
  static constexpr std::uint32_t kApi = 2;  ///< see kPluginApi
  virtual ~LocalMapper();

  /// Adds the key frame under its own id, which is map.keyframe_id_end(), with its landmarks.
  /// Quick. `map` is the newest version, with corrections of loops that came since the last call,
  /// or without an element where the tracker begins anew.
  virtual SparseMap insert(SparseMap map, KeyFrame keyframe) = 0;

  /// Triangulates, fuses, culls and adjusts around the key frame inserted last. `end_early` is
  /// requested when another key frame waits: end early with a consistent map. Never requested
  /// inline.
  virtual SparseMap refine(SparseMap map, KeyFrameId keyframe, std::stop_token end_early) = 0;
};

}  // namespace stillpoint
