#include "stillpoint/runtime/motion_stage.hpp"

#include <utility>

#include "stillpoint/runtime/stage_results.hpp"

namespace stillpoint {
namespace {

MovingPoints check_motion(MovingChecker& checker, const Frame& previous, const Frame& frame) {
  MovingPoints found = checker.check(previous, frame);
  check_moving_points(found);
  return found;
}

MapEvidence compare(MapChecker& checker, const Frame& frame, std::span<const Pose> guesses,
                    const SparseMap& map) {
  MapEvidence found = checker.check(frame, guesses, map);
  check_evidence(found);
  return found;
}

}  // namespace

MotionStage::MotionStage(Stage<MovingChecker> moving_checker, Stage<MapChecker> map_checker,
                         SegmentationStage& segmentation, Mode mode, StopSignal& stop,
                         TimeLog& times)
    : segmentation_(segmentation),
      times_(times),
      moving_checker_(std::move(moving_checker), "moving check", times),
      map_checker_(std::move(map_checker), "map check", times),
      thread_(moving_checker_.present() || map_checker_.present() ? mode : Mode::kInline, 1, stop,
              [this](const Job& job) { find(job); }) {}

void MotionStage::offer(const FramePtr& frame, MapStore::Snapshot map) {
  Job job{frame, std::move(map)};
  if (thread_.threaded())
    thread_.push(std::move(job));
  else
    offered_ = std::move(job);
}

SceneMotion MotionStage::at(const FramePtr& frame) {
  if (!thread_.threaded()) {
    find(std::exchange(offered_, {}));
    return found_;
  }
  const ScopedTime time(times_, "motion_wait", frame->index);
  return thread_.wait_idle() ? found_ : SceneMotion{};
}

void MotionStage::tracked(const FramePtr& frame, std::shared_ptr<const StaticWeights> weights,
                          const TrackResult& result, MapStore::Snapshot map) {
  if (!map_checker_.present()) return;
  to_remember_.reset();
  if (result.state == TrackState::kTracking)
    to_remember_ = {frame, std::move(weights), result.reference, result.reference_from_camera,
                    result.world_from_camera};
  prediction_.tracked(to_remember_, *map);
}

void MotionStage::find(const Job& job) {
  const Frame& frame = *job.frame;
  found_ = {};
  if (previous_)
    found_.points =
        moving_checker_.call("moving_check", frame.index, check_motion, *previous_, frame);
  found_.evidence = compare_with_map(job);
  found_.labels = segmentation_.at(job.frame);  // waits (paper), or propagates the newest
  previous_ = job.frame;
}

MapEvidence MotionStage::compare_with_map(const Job& job) {
  if (!map_checker_.present()) return {};
  const std::uint32_t index = job.frame->index;
  if (const auto tracked = std::exchange(to_remember_, std::nullopt))
    map_checker_.call("map_check", index, &MapChecker::remember, *tracked);
  const std::vector<Pose> guesses = prediction_.guesses(job.frame->time, found_.points, *job.map);
  if (guesses.empty()) return {};
  return map_checker_.call("map_check", index, compare, *job.frame, guesses, *job.map);
}

}  // namespace stillpoint
