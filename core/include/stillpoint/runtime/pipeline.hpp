// The program: Fig. 2 of the paper, with a stage in each box.
#pragma once

#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <stop_token>
#include <vector>

#include "stillpoint/runtime/beside_tracking.hpp"
#include "stillpoint/runtime/frame_feed.hpp"
#include "stillpoint/runtime/map_check.hpp"
#include "stillpoint/runtime/mapping_system.hpp"
#include "stillpoint/runtime/moving_check.hpp"
#include "stillpoint/runtime/output_stage.hpp"
#include "stillpoint/runtime/segmentation_stage.hpp"

namespace stillpoint {

/// One run over a recording. The caller of run() is thread 1, tracking; docs/threads.md tells about
/// the others.
class Pipeline {
 public:
  Pipeline(Stages stages, const RuntimeOptions& runtime, const SegmentationOptions& segmentation,
           std::unique_ptr<PaceClock> clock = std::make_unique<SteadyClock>());
  ~Pipeline() { stop_.request(); }

  /// Returns at the end of the recording, or early after a stop. Throws StageError when a stage
  /// failed. In each case, the outputs have been finished before. Once per object.
  void run(std::stop_token stop = {});

 private:
  void add_outputs(std::vector<OutputSetup> setups);
  void process(const FramePtr& frame);
  void report(FrameReportPtr report);
  void end_threads();
  void finish();
  RunSummary summary(const SparseMap& map, const SourceReport& source,
                     const std::vector<StageTime>& times) const;
  int dropped_reports() const;
  void keep_failure_of(const std::function<void()>& step);

  const RuntimeOptions options_;
  const std::filesystem::path map_directory_;
  const bool localise_only_;
  std::unique_ptr<PaceClock> clock_;
  StopSignal stop_;
  TimeLog times_;

  StageCaller<Decision> decision_;
  StageCaller<Tracker> tracker_;

  std::vector<TrackedPose> poses_;
  double wall_seconds_ = 0.0;
  double cpu_seconds_ = 0.0;

  // Last: their threads use the clock, the stop signal and the time log.
  FrameFeed feed_;
  SegmentationStage segmentation_;
  MovingCheck moving_check_;
  MapCheck map_check_;
  BesideTracking beside_;
  MappingSystem mapping_;
  std::deque<OutputStage> outputs_;  // a deque: they cannot be moved
};

}  // namespace stillpoint
