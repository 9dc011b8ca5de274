// Thread 2: runs the network and gives each frame its labels (paper III-B).
#pragma once

#include <atomic>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <string>

#include "stillpoint/runtime/stage.hpp"
#include "stillpoint/runtime/worker.hpp"

namespace stillpoint {

/// Schedule `wait`: every frame has its own labels, as in the paper. `latest`: the newest finished
/// labels are brought to the current frame by the propagator; between two frames that the network
/// takes lie `interval_seconds`, give or take the irregularity of time stamps, and of those that
/// come while it is busy only the newest waits. The first labels are always waited for, because the
/// map begins with them.
///
/// `latest` inline imitates a network that takes `latency_seconds` per image, by the times of the
/// frames, so that its effect can be studied without the clock.
class SegmentationStage {
 public:
  SegmentationStage(Stage<Segmenter> segmenter, Stage<Propagator> propagator,
                    const SegmentationOptions& options, Mode mode, StopSignal& stop,
                    TimeLog& times);

  /// Of the segmenter; none without one.
  const ClassNames& classes() const { return classes_; }

  /// Gives a frame to the network.
  void offer(const FramePtr& frame);
  /// Labels for the frame offered last, or null when the run was stopped meanwhile.
  SegmentationPtr labels_for(const FramePtr& frame);
  /// Ends the thread.
  void end() { network_.end(); }

  /// Frames that had no labels when they were tracked, calls of the segmenter that failed, and what
  /// the first of these said; after end().
  int unlabelled() const { return unlabelled_; }
  int failures() const { return failures_; }
  const std::string& first_failure() const { return first_failure_; }

 private:
  using Schedule = SegmentationOptions::Schedule;
  struct Labelled {
    FramePtr frame;
    SegmentationPtr labels;
  };

  FramePtr take(FramePtr frame);
  void segment(FramePtr frame);
  Segmentation labels_of(const Frame& frame);
  void imitate_latency(const FramePtr& now);
  Labelled wait_for(const FramePtr& frame);

  const SegmentationOptions options_;
  StopSignal& stop_;
  TimeLog& times_;
  StageCaller<Segmenter> segmenter_;
  StageCaller<Propagator> propagator_;
  const ClassNames classes_;  // of the segmenter

  std::mutex mutex_;
  std::condition_variable_any changed_;
  Labelled newest_;  // guarded by mutex_

  // Of `latest`, in seconds: the network takes no older frame.
  std::atomic<double> next_ = std::numeric_limits<double>::lowest();

  int unlabelled_ = 0;  // of the thread that calls labels_for()
  int failures_ = 0;    // both of the thread that segments
  std::string first_failure_;

  // Of `latest` inline: the frame in the imitated network and the one that waits for it.
  FramePtr running_;
  FramePtr waiting_;

  Worker<FramePtr> network_;  // last: its thread uses all the others
};

}  // namespace stillpoint
