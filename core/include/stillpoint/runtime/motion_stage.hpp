// Beside thread 1: what moves in a frame, found while tracking extracts its features (paper III-C).
#pragma once

#include "stillpoint/runtime/segmentation_stage.hpp"
#include "stillpoint/runtime/stage.hpp"
#include "stillpoint/runtime/worker.hpp"

namespace stillpoint {

/// What the decision is made from.
struct SceneMotion {
  MovingPoints points;     ///< unknown in the first frame, which has none before it
  SegmentationPtr labels;  ///< of this frame; null when the run was stopped meanwhile
};

/// Calls the moving check, then asks for the labels: both need the images alone. Inline, or without
/// a moving check, at() does it; otherwise a thread of its own.
class MotionStage {
 public:
  MotionStage(Stage<MovingChecker> checker, SegmentationStage& segmentation, Mode mode,
              StopSignal& stop, TimeLog& times);

  /// Begins with a frame, which `segmentation` must have been offered before.
  void offer(const FramePtr& frame);
  /// Waits for the frame offered last.
  SceneMotion at(const FramePtr& frame);
  /// Ends the thread.
  void end() { thread_.end(); }

 private:
  void find(const FramePtr& frame);

  SegmentationStage& segmentation_;
  TimeLog& times_;
  StageCaller<MovingChecker> checker_;

  // Of the thread, and of at() while the thread is idle.
  FramePtr previous_;
  SceneMotion found_;

  Worker<FramePtr> thread_;  // last: it uses all the others
};

}  // namespace stillpoint
