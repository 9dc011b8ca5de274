// Contract: recognises places seen before (paper III-A). Thread 4.
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>

#include "stillpoint/contracts/map_correction.hpp"
#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Has features, weights and poses of key frames, no images. A copy of the map may be kept.
class STILLPOINT_EXPORT LoopCloser {
 public:
  static constexpr const char* kKind = "loop_closer";
  static constexpr std::uint32_t kApi = 2;  ///< see kPluginApi
  virtual ~LoopCloser();

  /// Nothing when `latest` closes no loop or when `stop` is requested. Called for each key frame,
  /// in order, with the map as it was when that had been refined; refining may have removed it from
  /// the map. Left out while a correction is on its way into the map. What is kept of earlier calls
  /// counts no more where map.keyframe_id_begin() has grown: the tracker began anew.
  virtual std::optional<MapCorrection> close(const SparseMap& map, KeyFrameId latest,
                                             std::stop_token stop) = 0;

  /// After a correction has been applied: the whole map adjusted once more. `end_early` is
  /// requested when many key frames wait for close(): end early with the best so far. Never
  /// requested inline.
  virtual std::optional<MapCorrection> adjust(const SparseMap& map, std::stop_token end_early);
};

}  // namespace stillpoint
