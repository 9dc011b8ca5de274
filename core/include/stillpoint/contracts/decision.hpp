// Contract: weights per pixel from labels, moving points and map evidence (paper III-D). Thread 1.
#pragma once

#include <cstdint>
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/map_evidence.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/contracts/static_weights.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Says what is used for tracking and what for the map. Tracking waits for it.
class STILLPOINT_EXPORT Decision {
 public:
  static constexpr const char* kKind = "decision";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~Decision();

  /// Called once per frame, in order. Labels, points and evidence are those of this frame, and each
  /// can be empty: not known. Arguments are valid during the call. Weight images have the frame's
  /// size or are empty (255 everywhere).
  virtual StaticWeights decide(const Frame& frame, const Segmentation& segmentation,
                               const MovingPoints& moving, const MapEvidence& evidence) = 0;
};

}  // namespace stillpoint
