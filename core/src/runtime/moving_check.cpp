#include "stillpoint/runtime/moving_check.hpp"

#include <utility>

#include "stillpoint/runtime/perception_results.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint {
namespace {

MovingPoints check_motion(MovingChecker& checker, const Frame& previous, const Frame& frame,
                          const TrackingHistory& history, bool thorough) {
  MovingPoints found = checker.check(previous, frame, history);
  check_moving_points(found, frame.gray.size());
  if (thorough) check_thoroughly(found);
  return found;
}

}  // namespace

MovingPoints MovingCheck::at(const FramePtr& frame, const SparseMap& map) {
  const FramePtr previous = std::exchange(previous_, frame);
  if (!previous) return {};
  return checker_.call("moving_check", frame->index, check_motion, *previous, *frame, history(map),
                       thorough_);
}

void MovingCheck::keyframe(const DenseKeyFrame& keyframe) {
  keyframes_.push_front(keyframe);
  if (keyframes_.size() > wanted_keyframes_) keyframes_.pop_back();
}

TrackingHistory MovingCheck::history(const SparseMap& map) const {
  TrackingHistory history{.world_from_previous = std::nullopt,
                          .keyframes = {keyframes_.begin(), keyframes_.end()}};
  if (previous_tracked_) history.world_from_previous = previous_tracked_->pose_in(map);
  for (DenseKeyFrame& keyframe : history.keyframes)
    if (keyframe.id < map.keyframe_id_end())
      keyframe.world_from_camera = map.world_from_keyframe(keyframe.id);
  return history;
}

}  // namespace stillpoint
