// The program: Fig. 2 of the paper, with a stage in each box.
#pragma once

#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "stillpoint/engine/pace_clock.hpp"
#include "stillpoint/engine/thread_watch.hpp"
#include "stillpoint/runtime/beside_tracking.hpp"
#include "stillpoint/runtime/controlled_run.hpp"
#include "stillpoint/runtime/frame_feed.hpp"
#include "stillpoint/runtime/map_check.hpp"
#include "stillpoint/runtime/mapping_system.hpp"
#include "stillpoint/runtime/moving_check.hpp"
#include "stillpoint/runtime/output_stage.hpp"
#include "stillpoint/runtime/segmentation_stage.hpp"

namespace stillpoint {

/// What is behind an Engine, which says what its calls do. The caller is thread 1, tracking;
/// docs/threads.md tells about the others.
class Pipeline {
 public:
  /// `clock` null: the steady clock.
  Pipeline(Stages stages, const RuntimeOptions& runtime, const SegmentationOptions& segmentation,
           std::shared_ptr<PaceClock> clock = nullptr);
  ~Pipeline();

  FrameReportPtr push(Frame frame);
  void run(std::stop_token stop);
  void finish();

  MapStore::Snapshot map() const { return mapping_.snapshot(); }
  std::vector<LabelledPoint> dense_map() { return mapping_.dense_points(); }
  bool save_dense_map(const std::filesystem::path& directory) { return mapping_.save(directory); }
  const ClassNames& classes() const { return segmentation_.classes(); }
  const std::vector<TrackedPose>& poses() const { return poses_; }

 private:
  void add_outputs(std::vector<OutputSetup> setups);
  void begin_outputs();
  FrameReportPtr process(const FramePtr& frame);
  bool begin_anew(const Frame& with);
  void add(NewKeyFrame keyframe);
  void record(const FrameReportPtr& report);
  void end_threads();
  void finish_outputs();
  void save_dense_map_of_run();
  RunSummary summary(const SparseMap& map, const SourceReport& source,
                     const std::vector<StageTime>& times);
  int dropped_reports() const;
  void keep_failure_of(const std::function<void()>& step);
  void throw_failure() const;

  const RuntimeOptions options_;
  const std::filesystem::path map_directory_;
  const bool localise_only_;
  const bool may_begin_anew_;
  const std::function<void(LogLevel, std::string_view)> log_;
  const std::function<void()> before_outputs_;
  const std::function<void(const std::vector<std::filesystem::path>&)> map_saved_;
  const std::shared_ptr<PaceClock> clock_;
  const double wall_start_;
  const double cpu_start_;
  StopSignal stop_;
  ThreadWatch plugin_threads_{[this](std::exception_ptr failure) { stop_.fail(failure); }};
  TimeLog times_;

  Stage<Source> source_;  // until run()
  StageCaller<Decision> decision_;
  StageCaller<Tracker> tracker_;

  FramePtr pushed_;  // the last one
  std::vector<TrackedPose> poses_;
  bool finished_ = false;
  bool map_is_saved_ = false;
  double wall_seconds_ = 0.0;
  double cpu_seconds_ = 0.0;

  const std::shared_ptr<ControlledRun> controlled_run_;

  // Last: their threads use the clock, the stop signal and the time log.
  std::optional<FrameFeed> feed_;  // in run()
  SegmentationStage segmentation_;
  MovingCheck moving_check_;
  MapCheck map_check_;
  BesideTracking perception_;
  MappingSystem mapping_;
  std::deque<OutputStage> outputs_;  // a deque: they cannot be moved
};

}  // namespace stillpoint
