#include "stillpoint/runtime/motion_stage.hpp"

#include <utility>

namespace stillpoint {

MotionStage::MotionStage(Stage<MovingChecker> checker, SegmentationStage& segmentation, Mode mode,
                         StopSignal& stop, TimeLog& times)
    : segmentation_(segmentation),
      times_(times),
      checker_(std::move(checker), "moving check", times),
      thread_(checker_.present() ? mode : Mode::kInline, 1, stop,
              [this](const FramePtr& frame) { find(frame); }) {}

void MotionStage::offer(const FramePtr& frame) {
  if (thread_.threaded()) thread_.push(frame);
}

SceneMotion MotionStage::at(const FramePtr& frame) {
  if (!thread_.threaded()) {
    find(frame);
    return found_;
  }
  const ScopedTime time(times_, "motion_wait", frame->index);
  return thread_.wait_idle() ? found_ : SceneMotion{};
}

void MotionStage::find(const FramePtr& frame) {
  found_ = {};
  if (previous_)
    found_.points =
        checker_.call("moving_check", frame->index, &MovingChecker::check, *previous_, *frame);
  found_.labels = segmentation_.at(frame);  // waits (paper), or propagates the newest
  previous_ = frame;
}

}  // namespace stillpoint
