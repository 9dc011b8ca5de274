// Beside thread 1: what moves in a frame, found while tracking extracts its features (paper III-C).
#pragma once

#include "stillpoint/runtime/map_store.hpp"
#include "stillpoint/runtime/pose_prediction.hpp"
#include "stillpoint/runtime/segmentation_stage.hpp"
#include "stillpoint/runtime/stage.hpp"
#include "stillpoint/runtime/worker.hpp"

namespace stillpoint {

/// What the decision is made from.
struct SceneMotion {
  MovingPoints points;     ///< unknown in the first frame, which has none before it
  MapEvidence evidence;    ///< unknown while nothing has been tracked
  SegmentationPtr labels;  ///< of this frame; null when the run was stopped meanwhile
};

/// Calls the moving check, then the map check at the poses that the camera may have, then asks for
/// the labels: all need the images and what is known of the frames before. Inline, or without a
/// moving check and a map check, at() does it; otherwise a thread of its own.
class MotionStage {
 public:
  MotionStage(Stage<MovingChecker> moving_checker, Stage<MapChecker> map_checker,
              SegmentationStage& segmentation, Mode mode, StopSignal& stop, TimeLog& times);

  /// Begins with a frame, which `segmentation` must have been offered before.
  void offer(const FramePtr& frame, MapStore::Snapshot map);
  /// Waits for the frame offered last.
  SceneMotion at(const FramePtr& frame);
  /// What became of the frame asked for last; before the next one is offered.
  void tracked(const FramePtr& frame, std::shared_ptr<const StaticWeights> weights,
               const TrackResult& result, MapStore::Snapshot map);
  /// Ends the thread.
  void end() { thread_.end(); }

 private:
  struct Job {
    FramePtr frame;
    MapStore::Snapshot map;
  };

  void find(const Job& job);
  MapEvidence compare_with_map(const Job& job);

  SegmentationStage& segmentation_;
  TimeLog& times_;
  StageCaller<MovingChecker> moving_checker_;
  StageCaller<MapChecker> map_checker_;
  Job offered_;  // inline, until at()

  // Of the thread, and of the others while the thread is idle.
  FramePtr previous_;
  PosePrediction prediction_;
  std::optional<TrackedFrame> to_remember_;
  SceneMotion found_;

  Worker<Job> thread_;  // last: it uses all the others
};

}  // namespace stillpoint
