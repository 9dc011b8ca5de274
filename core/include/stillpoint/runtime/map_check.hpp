// The map check of each frame, at the poses that the camera may have before it is tracked.
#pragma once

#include <optional>

#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/runtime/pose_prediction.hpp"
#include "stillpoint/runtime/stage.hpp"

namespace stillpoint {

class MapCheck {
 public:
  MapCheck(Stage<MapChecker> checker, const RuntimeOptions& options, TimeLog& times)
      : checker_(std::move(checker), "map check", times), thorough_(options.validates_fully()) {}

  bool present() const { return checker_.present(); }
  /// Once per frame, in order. Nothing is known while nothing has been tracked.
  MapEvidence check(const Frame& frame, const MovingPoints& moving, const SparseMap& map);
  /// The frame that check() was called for last, once it has been tracked; nothing: it was not.
  /// Before check() is called for the next one.
  void tracked(const std::optional<TrackedFrame>& frame, const SparseMap& map);
  /// Forgets all frames, as their map is cleared.
  void clear();

 private:
  StageCaller<MapChecker> checker_;
  const bool thorough_;
  PosePrediction prediction_;
  std::optional<TrackedFrame> to_remember_;
  bool to_clear_ = false;
};

}  // namespace stillpoint
