// Contract: which points move by themselves (paper III-C, Algorithm 1). Beside thread 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "stillpoint/contracts/dense_keyframe.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// What is known before a frame is checked, for checks that look further back than one frame. Poses
/// are those of the map as it is now; key frames that are not in it yet are where they were
/// tracked.
struct TrackingHistory {
  std::optional<Pose> world_from_previous;  ///< of the frame before; nothing: it was not tracked
  std::vector<DenseKeyFrame> keyframes;     ///< newest first
};

/// Needs no labels. Frames are valid during the call; copies, and what the history points to, may
/// be kept.
class STILLPOINT_EXPORT MovingChecker {
 public:
  static constexpr const char* kKind = "moving_checker";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~MovingChecker();

  /// For each frame but the first, in order. `previous` is the frame processed before, tracked or
  /// not. Both have the same size.
  virtual MovingPoints check(const Frame& previous, const Frame& current,
                             const TrackingHistory& history) = 0;

  /// How many key frames of the history check() looks at, at most; asked once, before the first
  /// frame; 400 at most. Default: 0. Their images stay in memory, 2.5 MB each of 640 × 480 pixels.
  virtual std::size_t wanted_keyframes() const;
};

}  // namespace stillpoint
