#include "stillpoint/runtime/pipeline.hpp"

#include <string>
#include <utility>

#include "stillpoint/runtime/stage_results.hpp"

namespace stillpoint {
namespace {

std::string message_of(const std::exception_ptr& failure) {
  if (!failure) return {};
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return error.what();
  }
}

StaticWeights decide(Decision& decision, const Frame& frame, const Segmentation& labels,
                     const MovingPoints& moving, const MapEvidence& evidence) {
  StaticWeights weights = decision.decide(frame, labels, moving, evidence);
  check_weights(weights, labels, frame.gray.size());
  return weights;
}

TrackResult track(Tracker& tracker, const FramePtr& frame, const StaticWeights& weights,
                  const SparseMap& map, TrackHints hints, KeyFrameId next_keyframe) {
  TrackResult result = tracker.track(frame, weights, map, hints);
  check_tracking(result, *frame, map, next_keyframe);
  return result;
}

NewKeyFrame new_keyframe(const KeyFrame& keyframe, const FramePtr& frame,
                         const SegmentationPtr& labels,
                         const std::shared_ptr<const StaticWeights>& weights) {
  return {keyframe, {keyframe.id, frame, labels, weights, keyframe.world_from_camera}};
}

}  // namespace

Pipeline::Pipeline(Stages stages, const RuntimeOptions& runtime,
                   const SegmentationOptions& segmentation, std::unique_ptr<PaceClock> clock)
    : options_(runtime),
      map_directory_(std::move(stages.map_directory)),
      localise_only_(stages.localise_only),
      clock_(std::move(clock)),
      decision_(std::move(stages.decision), "decision", times_),
      tracker_(std::move(stages.tracker), "tracking", times_),
      feed_(std::move(stages.source), runtime, *clock_, stop_, times_),
      segmentation_(std::move(stages.segmenter), std::move(stages.propagator), segmentation,
                    runtime.mode, stop_, times_),
      motion_(std::move(stages.moving_checker), std::move(stages.map_checker), segmentation_,
              runtime.mode, stop_, times_),
      mapping_(std::move(stages.local_mapper), std::move(stages.loop_closer),
               std::move(stages.map_backend), std::move(stages.known_map), runtime.mode, stop_,
               times_) {
  next_keyframe_ = static_cast<KeyFrameId>(mapping_.snapshot()->keyframe_id_end());
  for (Stage<Output>& output : stages.outputs)
    outputs_.emplace_back(std::move(output), "output", times_);
}

void Pipeline::run(std::stop_token stop) {
  const std::stop_callback forward(std::move(stop), [this] { stop_.request(); });
  const double wall_start = SteadyClock().now();
  const double cpu_start = process_cpu_seconds();
  keep_failure_of([this] {
    while (const FramePtr frame = feed_.next()) process(frame);
  });
  end_threads();
  wall_seconds_ = SteadyClock().now() - wall_start;
  cpu_seconds_ = process_cpu_seconds() - cpu_start;
  finish();
  if (const auto failure = stop_.failure()) std::rethrow_exception(failure);
}

void Pipeline::process(const FramePtr& frame) {
  const std::uint32_t index = frame->index;
  const ScopedTime time(times_, "track_thread", index);
  segmentation_.offer(frame);                                 // thread 2
  motion_.offer(frame, mapping_.snapshot());                  // moving points, labels of this frame
  tracker_.call("prepare", index, &Tracker::prepare, frame);  // overlaps both
  const auto [moving, evidence, labels] = motion_.at(frame);
  if (!labels) return;  // stopped meanwhile
  const auto weights = std::make_shared<const StaticWeights>(
      decision_.call("decision", index, decide, *frame, *labels, moving, evidence));
  const auto result = tracker_.call("track", index, track, frame, *weights, *mapping_.snapshot(),
                                    TrackHints{mapping_.waiting(), localise_only_}, next_keyframe_);
  if (result.keyframe) ++next_keyframe_;
  if (result.keyframe) mapping_.push(new_keyframe(*result.keyframe, frame, labels, weights));
  motion_.tracked(frame, weights, result, mapping_.snapshot());
  report({*frame, *labels, moving, evidence, *weights, result, times_.take()});
}

void Pipeline::report(const FrameReport& report) {
  const std::uint32_t index = report.frame.index;
  const TrackResult& result = report.result;
  poses_.push_back({.frame = index,
                    .time = report.frame.time,
                    .state = result.state,
                    .reference = result.reference,
                    .reference_from_camera = result.reference_from_camera,
                    .held_by_depth = result.held_by_depth,
                    .poorly_constrained = result.state == TrackState::kTracking &&
                                          result.uncertainty.poorly_constrained()});
  const ScopedTime time(times_, "outputs", index);
  for (StageCaller<Output>& output : outputs_)
    output.call_unmeasured(index, &Output::frame, report);
}

void Pipeline::end_threads() {
  motion_.end();
  segmentation_.end();
  mapping_.end();
  feed_.end();
}

void Pipeline::finish() {
  const MapStore::Snapshot map = mapping_.snapshot();
  const SourceReport source = feed_.report();
  const std::vector<StageTime> times = times_.take();
  if (!map_directory_.empty()) keep_failure_of([this] { mapping_.save(map_directory_); });
  for (StageCaller<Output>& output : outputs_) {
    keep_failure_of(
        [&] { output.call_unmeasured({}, &Output::finish, summary(*map, source, times)); });
  }
}

RunSummary Pipeline::summary(const SparseMap& map, const SourceReport& source,
                             const std::vector<StageTime>& times) const {
  return {.map = map,
          .poses = poses_,
          .source = source,
          .times = times,
          .dropped_frames = static_cast<int>(feed_.dropped()),
          .loops_closed = mapping_.loops(),
          .wall_seconds = wall_seconds_,
          .cpu_seconds = cpu_seconds_,
          .recorded_seconds = poses_.empty() ? 0.0 : poses_.back().time - poses_.front().time,
          .seed = options_.seed,
          .mode = options_.mode == Mode::kInline ? "inline" : "threaded",
          .unlabelled_frames = segmentation_.unlabelled(),
          .segmentation_failures = segmentation_.failures(),
          .segmentation_failure = segmentation_.first_failure(),
          .complete = !stop_.requested(),
          .failure = message_of(stop_.failure())};
}

void Pipeline::keep_failure_of(const std::function<void()>& step) {
  try {
    step();
  } catch (...) {
    stop_.fail(std::current_exception());
  }
}

}  // namespace stillpoint
