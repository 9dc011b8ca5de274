#include "stillpoint/runtime/pipeline.hpp"

#include <algorithm>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "stillpoint/engine/stage_error.hpp"
#include "stillpoint/runtime/folder_contents.hpp"
#include "stillpoint/runtime/mapping_results.hpp"
#include "stillpoint/runtime/perception_results.hpp"
#include "stillpoint/runtime/read_only_images.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

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

PreparedFramePtr prepare(Tracker& tracker, const FramePtr& frame) {
  PreparedFramePtr prepared = tracker.prepare(frame);
  check_prepared(prepared.get(), *frame);
  return prepared;
}

TrackResult track(Tracker& tracker, PreparedFramePtr prepared, const StaticWeights& weights,
                  const SparseMap& map, TrackHints hints, bool thorough) {
  const FramePtr frame = prepared->frame;
  TrackResult result = tracker.track(std::move(prepared), weights, map, hints);
  check_tracking(result, *frame, map, hints);
  if (thorough) check_thoroughly(result);
  return result;
}

bool is_waited_for(const OutputSetup& setup) {
  if (setup.when_full != WhenFull::kAuto) return setup.when_full == WhenFull::kWait;
  return !in_stage("output (" + setup.stage.type + ")", {},
                   [&] { return setup.stage.object->may_miss_frames(); });
}

void check_pushed(const Frame& frame, const Frame* previous, bool thorough) {
  try {
    check_frame(frame, frame.index, previous);
    if (thorough) check_thoroughly(frame);
  } catch (const Error& error) {
    throw Error(Fault::kData, error.what(), "frame " + std::to_string(frame.index));
  }
}

NewKeyFrame new_keyframe(const KeyFrame& keyframe, const FramePtr& frame,
                         const SegmentationPtr& labels,
                         const std::shared_ptr<const StaticWeights>& weights) {
  return {keyframe, {keyframe.id, frame, labels, weights, keyframe.world_from_camera}};
}

std::optional<TrackedFrame> tracked_frame(const FramePtr& frame,
                                          const std::shared_ptr<const StaticWeights>& weights,
                                          const TrackResult& result) {
  if (result.state != TrackState::kTracking) return std::nullopt;
  return TrackedFrame{frame, weights, result.reference, result.reference_from_camera,
                      result.world_from_camera};
}

}  // namespace

Pipeline::Pipeline(Stages stages, const RuntimeOptions& runtime,
                   const SegmentationOptions& segmentation, std::shared_ptr<PaceClock> clock)
    : options_(runtime),
      map_directory_(std::move(stages.map_directory)),
      localise_only_(stages.localise_only),
      may_begin_anew_(stages.known_map.empty() && !localise_only_),
      log_(stages.log ? std::move(stages.log) : [](LogLevel, std::string_view) {}),
      before_outputs_(stages.before_outputs ? std::move(stages.before_outputs) : [] {}),
      map_saved_(std::move(stages.map_saved)),
      clock_(clock ? std::move(clock) : std::make_shared<SteadyClock>()),
      wall_start_(SteadyClock().now()),
      cpu_start_(process_cpu_seconds()),
      source_(std::move(stages.source)),
      decision_(std::move(stages.decision), "decision", times_),
      tracker_(std::move(stages.tracker), "tracking", times_),
      controlled_run_(std::make_shared<ControlledRun>(
          ControlledRun::Reach{
              .map = [this] { return mapping_.snapshot(); },
              .dense_map = [this] { return mapping_.dense_points_if_idle(); },
              .save_dense_map = [this](const auto& into) { return mapping_.save_if_idle(into); }},
          std::move(stages.map_file))),
      segmentation_(std::move(stages.segmenter), std::move(stages.propagator), segmentation,
                    runtime.mode, stop_, times_),
      moving_check_(std::move(stages.moving_checker), runtime, times_),
      map_check_(std::move(stages.map_checker), runtime, times_),
      perception_(moving_check_.present() || map_check_.present() ? runtime.mode : Mode::kInline,
                  stop_, times_),
      mapping_(std::move(stages.local_mapper), std::move(stages.loop_closer),
               std::move(stages.map_backend), std::move(stages.known_map), runtime, stop_, times_) {
  add_outputs(std::move(stages.outputs));
}

Pipeline::~Pipeline() {
  if (finished_) return;
  stop_.request();
  try {
    finish();
  } catch (const std::exception&) {  // of interest to those who call finish()
  }
}

// Those that tracking waits for share a thread: one that holds up tracking holds up all.
void Pipeline::add_outputs(std::vector<OutputSetup> setups) {
  const auto first_to_drop = std::stable_partition(setups.begin(), setups.end(), is_waited_for);
  std::vector<Stage<Output>> waited_for;
  for (auto setup = setups.begin(); setup != first_to_drop; ++setup)
    waited_for.push_back(std::move(setup->stage));
  outputs_.emplace_back(std::move(waited_for), WhenFull::kWait, options_.mode, stop_, times_);
  for (auto setup = first_to_drop; setup != setups.end(); ++setup)
    outputs_.emplace_back(std::vector{std::move(setup->stage)}, WhenFull::kDrop, options_.mode,
                          stop_, times_);
}

void Pipeline::begin_outputs() {
  for (OutputStage& output : outputs_) output.begin(controlled_run_);
}

FrameReportPtr Pipeline::push(Frame frame) {
  if (finished_ || feed_)
    throw Error(Fault::kUsage, "no frame can be pushed during run() or after finish()");
  throw_failure();
  const bool is_first = !pushed_;
  frame.index = is_first ? 0 : pushed_->index + 1;
  if (frame.gray.empty() && !frame.bgr.empty() && frame.bgr.type() == CV_8UC3)
    cv::cvtColor(frame.bgr, frame.gray, cv::COLOR_BGR2GRAY);
  check_pushed(frame, pushed_.get(), options_.validates_fully());
  if (options_.validates_fully()) frame = with_read_only_images(std::move(frame));
  pushed_ = std::make_shared<const Frame>(std::move(frame));
  FrameReportPtr report;
  keep_failure_of([&] {
    if (is_first) {
      controlled_run_->give_up_steering();
      begin_outputs();
    }
    report = process(pushed_);
  });
  throw_failure();
  return report;
}

void Pipeline::run(std::stop_token stop) {
  if (finished_ || feed_ || pushed_)
    throw Error(Fault::kUsage, "run() can be called once, and not after process()");
  const auto request_stop = [this] { stop_.request(); };
  const std::stop_callback by_caller(std::move(stop), request_stop);
  const std::stop_callback by_output(controlled_run_->stop_token(), request_stop);
  keep_failure_of([this] {
    begin_outputs();
    feed_.emplace(std::move(source_), options_, *clock_, *controlled_run_, stop_, times_);
    while (const FramePtr frame = feed_->next()) process(frame);
  });
  finish();
}

void Pipeline::finish() {
  if (finished_) throw Error(Fault::kUsage, "the run is finished already");
  finished_ = true;
  end_threads();
  controlled_run_->end();
  wall_seconds_ = SteadyClock().now() - wall_start_ - controlled_run_->paused_seconds();
  cpu_seconds_ = process_cpu_seconds() - cpu_start_;
  finish_outputs();
  throw_failure();
}

FrameReportPtr Pipeline::process(const FramePtr& frame) {
  const std::uint32_t index = frame->index;
  const ScopedTime time(times_, "track_thread", index);
  segmentation_.offer(frame);  // thread 2
  const auto map = mapping_.snapshot();
  const auto moving = perception_.start([=, this] { return moving_check_.check(frame, *map); });
  const auto evidence =
      perception_.start([=, this] { return map_check_.check(*frame, *moving, *map); });
  const auto labels = perception_.start([=, this] { return segmentation_.labels_for(frame); });
  auto prepared = tracker_.call("prepare", index, prepare, frame);  // meanwhile
  if (!perception_.wait(index) || !*labels) return nullptr;         // stopped
  const auto weights = std::make_shared<const StaticWeights>(
      decision_.call("decision", index, decide, *frame, **labels, *moving, *evidence));
  TrackResult result =
      tracker_.call("track", index, track, std::move(prepared), *weights, *mapping_.snapshot(),
                    TrackHints{.next_keyframe = mapping_.next_keyframe(),
                               .mapping_waiting = mapping_.waiting(),
                               .localise_only = localise_only_,
                               .may_begin_anew = may_begin_anew_},
                    options_.validates_fully());
  const auto tracked = tracked_frame(frame, weights, result);
  moving_check_.tracked(tracked);
  if (result.begins_anew && !begin_anew(*frame)) return nullptr;  // stopped
  if (result.keyframe) add(new_keyframe(*result.keyframe, frame, *labels, weights));
  map_check_.tracked(tracked, *mapping_.snapshot());
  const auto report = std::make_shared<const FrameReport>(
      FrameReport{frame, *labels, *moving, *evidence, weights, std::move(result), times_.take(),
                  mapping_.snapshot(), mapping_.loops(), feed_ ? feed_->left_out() : 0});
  record(report);
  return report;
}

// What was tracked in the map that is cleared has no pose in the next one.
bool Pipeline::begin_anew(const Frame& with) {
  if (!mapping_.clear()) return false;
  moving_check_.clear();
  map_check_.clear();
  int tracked = 0;
  for (TrackedPose& pose : poses_) {
    if (pose.state != TrackState::kTracking) continue;
    pose = {.frame = pose.frame, .time = pose.time, .state = TrackState::kWaiting};
    ++tracked;
  }
  log_(LogLevel::kWarning,
       "the tracker gives up its map and begins a new one with frame " +
           std::to_string(with.index) +
           "; frames tracked before, which have no pose any more: " + std::to_string(tracked));
  return true;
}

void Pipeline::add(NewKeyFrame keyframe) {
  moving_check_.keyframe(keyframe.images);
  mapping_.push(std::move(keyframe));
}

void Pipeline::record(const FrameReportPtr& report) {
  if (poses_.empty()) before_outputs_();
  const TrackResult& result = report->result;
  poses_.push_back({.frame = report->frame->index,
                    .time = report->frame->time,
                    .state = result.state,
                    .reference = result.reference,
                    .reference_from_camera = result.reference_from_camera,
                    .world_from_camera = result.world_from_camera,
                    .depth_registered = result.depth_registered,
                    .poorly_constrained = result.state == TrackState::kTracking &&
                                          result.uncertainty &&
                                          result.uncertainty->poorly_constrained()});
  for (OutputStage& output : outputs_) output.frame(report);
}

void Pipeline::end_threads() {
  perception_.end();
  segmentation_.end();
  mapping_.end();
  if (feed_) feed_->end();
  for (OutputStage& output : outputs_) output.end();
}

void Pipeline::finish_outputs() {
  // A source without frames is a whole recording; where none is pushed, there is no run.
  const auto has_begun = [&] { return !poses_.empty() || (feed_ && !stop_.requested()); };
  if (has_begun() && poses_.empty()) keep_failure_of(before_outputs_);
  const bool begun = has_begun();
  const MapStore::Snapshot map = mapping_.snapshot();
  SourceReport source;
  if (feed_) keep_failure_of([&] { source = feed_->report(); });
  const std::vector<StageTime> times = times_.take();
  if (!map_directory_.empty() && begun) save_dense_map_of_run();
  const auto last = begun ? &Output::finish : &Output::ended_before_first_frame;
  for (OutputStage& output : outputs_)
    output.finish(last, [&] { return summary(*map, source, times); });
}

void Pipeline::save_dense_map_of_run() {
  const FolderContents before(map_directory_);
  keep_failure_of([&] { map_is_saved_ = mapping_.save(map_directory_); });
  if (map_saved_) keep_failure_of([&] { map_saved_(before.written_since()); });
}

RunSummary Pipeline::summary(const SparseMap& map, const SourceReport& source,
                             const std::vector<StageTime>& times) {
  return {.map = map,
          .poses = poses_,
          .source = source,
          .times = times,
          .dropped_frames = feed_ ? static_cast<int>(feed_->dropped()) : 0,
          .loops_closed = mapping_.loops(),
          .dropped_reports = dropped_reports(),
          .wall_seconds = wall_seconds_,
          .cpu_seconds = cpu_seconds_,
          .recorded_seconds = poses_.empty() ? 0.0 : poses_.back().time - poses_.front().time,
          .seed = options_.seed,
          .mode = options_.mode == Mode::kInline ? "inline" : "threaded",
          .unlabelled_frames = segmentation_.unlabelled(),
          .segmentation_failures = segmentation_.failures(),
          .segmentation_failure = segmentation_.first_failure(),
          .complete = !stop_.requested(),
          .failure = message_of(stop_.failure()),
          .map_directory = map_is_saved_ ? map_directory_ : std::filesystem::path(),
          .dense_map = [this] { return mapping_.dense_points(); }};
}

int Pipeline::dropped_reports() const {
  return std::accumulate(outputs_.begin(), outputs_.end(), 0,
                         [](int sum, const auto& output) { return sum + output.dropped(); });
}

void Pipeline::keep_failure_of(const std::function<void()>& step) {
  try {
    step();
  } catch (...) {
    stop_.fail(std::current_exception());
  }
}

void Pipeline::throw_failure() const {
  if (const auto failure = stop_.failure()) std::rethrow_exception(failure);
}

}  // namespace stillpoint
