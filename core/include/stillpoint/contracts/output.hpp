// Contract: writes or shows the results of a run (paper IV). A thread of its own, behind a queue.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/labelled_point.hpp"
#include "stillpoint/contracts/live_run.hpp"
#include "stillpoint/contracts/map_evidence.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/contracts/source.hpp"
#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/contracts/static_weights.hpp"
#include "stillpoint/contracts/tracker.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Time one stage took for one frame.
struct StageTime {
  std::string stage;        ///< "source", "prepare", "moving_check", "track", "map_insert", …
  double wall_ms = 0.0;     ///< milliseconds of wall-clock time
  double cpu_ms = 0.0;      ///< milliseconds of processor time of the stage's own thread
  std::uint32_t frame = 0;  ///< index of the frame the work was for
};

/// Everything the pipeline knows of one frame. Images are shared with the stages: never write them.
struct FrameReport {
  FramePtr frame;
  SegmentationPtr segmentation;
  MovingPoints moving;
  MapEvidence evidence;
  std::shared_ptr<const StaticWeights> weights;
  TrackResult result;
  /// Of the calls that ended since the last report: of this frame, and on other threads.
  std::vector<StageTime> times;
  /// A snapshot of when the frame had been tracked. Never null in a run.
  std::shared_ptr<const SparseMap> map;
  int loops_closed = 0;      ///< since the run began
  std::size_t left_out = 0;  ///< images that the source had left out by then, as far as it knows
};
using FrameReportPtr = std::shared_ptr<const FrameReport>;

/// One frame's pose, relative to its reference key frame.
struct TrackedPose {
  std::uint32_t frame = 0;
  double time = 0.0;  ///< seconds
  TrackState state = TrackState::kWaiting;
  KeyFrameId reference = kNoId;
  Pose reference_from_camera = Pose::Identity();
  Pose world_from_camera = Pose::Identity();  ///< at the time of tracking
  bool depth_registered = false;              ///< as in TrackResult
  bool poorly_constrained = false;            ///< as in PoseUncertainty
};

struct RunSummary {
  const SparseMap& map;
  const std::vector<TrackedPose>& poses;  ///< of all frames processed, in order
  const SourceReport& source;
  const std::vector<StageTime>& times;  ///< what ended since the last report
  int dropped_frames = 0;               ///< by `pace: sensor`
  int loops_closed = 0;
  int dropped_reports = 0;    ///< by outputs that were too slow and may miss frames
  double wall_seconds = 0.0;  ///< without pauses
  double cpu_seconds = 0.0;   ///< of the whole process during the run
  double recorded_seconds = 0.0;
  long long seed = 0;
  std::string mode;                     ///< "inline" or "threaded"
  int unlabelled_frames = 0;            ///< without labels although there is a segmenter
  int segmentation_failures = 0;        ///< images that it failed on, with `on_failure: continue`
  std::string segmentation_failure;     ///< the message of the first of them
  bool complete = true;                 ///< false when the run was stopped or failed
  std::string failure;                  ///< the message of the stage that failed, if any
  std::filesystem::path map_directory;  ///< the dense map's files; empty: there are none
  /// What the dense map holds, in the world, as MapBackend::occupied(); empty without one.
  std::function<std::vector<LabelledPoint>()> dense_map = [] {
    return std::vector<LabelledPoint>();
  };
};

/// A copy of a report may be kept; its images are shared.
class STILLPOINT_EXPORT Output {
 public:
  static constexpr const char* kKind = "output";
  static constexpr std::uint32_t kApi = 10;  ///< see kPluginApi
  virtual ~Output();

  /// Before the first frame, on thread 1. The pointer may be kept.
  virtual void begin(const std::shared_ptr<LiveRun>&) {}
  /// For viewers: frames may be left out when this output is too slow, instead of tracking waiting
  /// for it. `when_full` in the pipeline file has the last word.
  virtual bool may_miss_frames() const { return false; }
  /// In order of the frames. Threaded, tracking is up to eight frames ahead and then waits, or
  /// frames are left out.
  virtual void frame(const FrameReport&) {}
  /// Also called after a failure or Ctrl-C: what was computed is saved. Not after this output
  /// itself crashed or hung. After the last frame(), on thread 1; references are valid during the
  /// call only.
  virtual void finish(const RunSummary&) {}
  /// Instead of finish(), when the run failed or was stopped before its first frame. Leave the
  /// files of an earlier run as they are.
  virtual void ended_before_first_frame(const RunSummary&) {}
};

}  // namespace stillpoint
