// Contract: compares each depth image with earlier frames to find what has moved (DynaSLAM's
// multi-view geometry; not in the DS-SLAM paper). Beside thread 1.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/map_evidence.hpp"
#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/contracts/static_weights.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// A frame that has been tracked, with what was decided about it.
struct TrackedFrame {
  FramePtr frame;
  std::shared_ptr<const StaticWeights> weights;
  KeyFrameId reference = kNoId;
  Pose reference_from_camera = Pose::Identity();
  Pose world_from_camera = Pose::Identity();  ///< at the time of tracking

  /// Its present world_from_camera: it moves with its reference, which may not be in the map yet.
  STILLPOINT_EXPORT Pose pose_in(const SparseMap& map) const;
};

/// Compares with what it has been given to remember, or with the landmarks of the map. A
/// TrackedFrame, and a copy of a frame or of the map, may be kept until clear().
class STILLPOINT_EXPORT MapChecker {
 public:
  static constexpr const char* kKind = "map_checker";
  static constexpr std::uint32_t kApi = 3;  ///< see kPluginApi
  virtual ~MapChecker();

  /// Before a frame is tracked, when the frame before it was. `guesses` are poses it may have
  /// (world_from_camera), the likeliest first, at least one.
  virtual MapEvidence check(const Frame& frame, std::span<const Pose> guesses,
                            const SparseMap& map) = 0;

  /// After each frame that has been tracked, in order, before the next one is checked, on the same
  /// thread. Not for the last one.
  virtual void remember(const TrackedFrame& frame) = 0;

  /// Where the tracker has begun the map anew: forgets all frames, whose poses are of the map
  /// before. On the same thread.
  virtual void clear() = 0;
};

}  // namespace stillpoint
