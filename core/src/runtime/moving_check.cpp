#include "stillpoint/runtime/moving_check.hpp"

#include <string>
#include <utility>

#include "stillpoint/runtime/perception_results.hpp"
#include "stillpoint/runtime/stage_requirement.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint {
namespace {

constexpr std::size_t kMostKeyFrames = 400;  // a gigabyte of images of 640 x 480

MovingPoints check_motion(MovingChecker& checker, const Frame& previous, const Frame& frame,
                          const TrackingHistory& history, bool thorough) {
  MovingPoints found = checker.check(previous, frame, history);
  check_moving_points(found, frame.gray.size());
  if (thorough) check_thoroughly(found);
  return found;
}

std::size_t wanted_keyframes_of(MovingChecker& checker) {
  const std::size_t wanted = checker.wanted_keyframes();
  require_of_stage(wanted <= kMostKeyFrames,
                   "wanted_keyframes() gives " + std::to_string(wanted) + ", above " +
                       std::to_string(kMostKeyFrames),
                   "the images of that many key frames stay in memory: ask for fewer");
  return wanted;
}

}  // namespace

MovingCheck::MovingCheck(Stage<MovingChecker> checker, const RuntimeOptions& options,
                         TimeLog& times)
    : checker_(std::move(checker), "moving check", times),
      thorough_(options.validates_fully()),
      wanted_keyframes_(checker_.call_unmeasured({}, wanted_keyframes_of)) {}

MovingPoints MovingCheck::check(const FramePtr& frame, const SparseMap& map) {
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
