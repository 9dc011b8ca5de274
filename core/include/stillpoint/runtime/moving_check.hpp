// The moving check of each frame against the one before (paper III-C).
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/runtime/stage.hpp"

namespace stillpoint {

class MovingCheck {
 public:
  MovingCheck(Stage<MovingChecker> checker, const RuntimeOptions& options, TimeLog& times);

  bool present() const { return checker_.present(); }
  /// Once per frame, in order. Nothing is known of the first, which has none before it.
  MovingPoints check(const FramePtr& frame, const SparseMap& map);
  /// The frame that check() was called for last, once it has been tracked; nothing: it was not.
  /// Before check() is called for the next one.
  void tracked(const std::optional<TrackedFrame>& frame) { previous_tracked_ = frame; }
  /// The same frame, when it became a key frame.
  void keyframe(const DenseKeyFrame& keyframe);
  /// Forgets the key frames, as their map is cleared.
  void clear() { keyframes_.clear(); }

 private:
  TrackingHistory history(const SparseMap& map) const;

  StageCaller<MovingChecker> checker_;
  const bool thorough_;
  const std::size_t wanted_keyframes_;
  FramePtr previous_;
  std::optional<TrackedFrame> previous_tracked_;
  std::deque<DenseKeyFrame> keyframes_;  // newest first, poses at the time of tracking
};

}  // namespace stillpoint
