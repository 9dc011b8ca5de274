// Outputs: a run of the pipeline as they see it.
#include <memory>

#include "plugin_check/frame_drive.hpp"
#include "plugin_check/map_making.hpp"
#include "plugin_check/quiet_run.hpp"

namespace stillpoint::plugin_check {
namespace {

namespace fs = std::filesystem;

class OutputDrive final : public FrameDrive<Output> {
 public:
  using FrameDrive::FrameDrive;

  void finish() override {
    const std::vector<StageTime> times = {{"track", 5, 4, 0}};
    const RunSummary summary{.map = map_,
                             .poses = poses_,
                             .source = source_,
                             .times = times,
                             .seed = 1,
                             .mode = "inline",
                             .complete = false,
                             .failure = "tracking (orb) failed on frame 3: out of memory",
                             .dense_map = [] { return std::vector<LabelledPoint>(3); }};
    observer_.call("finish", {}, [&] { stage_.finish(summary); });
    require_no_unfinished_file();
  }

 private:
  void require_no_unfinished_file() const {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
      if (entry.path().extension() == ".part")
        throw Failure(
            {"finish() leaves a file whose name ends in .part, " + entry.path().filename().string(),
             "an AtomicFile without commit() is deleted when the run ends",
             "call commit() in finish()"});
  }

  bool begin() override {
    observer_.call("may_miss_frames", {}, [&] { return stage_.may_miss_frames(); });
    observer_.call("begin", {},
                   [&] { stage_.begin(std::make_shared<QuietRun>(!scenario_.is_pushed)); });
    return true;
  }

  // Waiting, tracking, lost and found again, as in a run that has known bad times.
  void at(std::size_t i) override {
    const Input& now = input(i);
    auto report = std::make_shared<FrameReport>();
    report->frame = now.frame;
    report->segmentation = now.segmentation;
    report->moving = now.moving;
    report->evidence = now.evidence;
    report->weights = now.weights;
    report->times = {{"track", 5, 4, now.frame->index}};
    report->result.state = i == 0       ? TrackState::kWaiting
                           : i % 5 == 3 ? TrackState::kLost
                                        : TrackState::kTracking;
    if (report->result.state == TrackState::kTracking) track(i, report->result);
    report->map = std::make_shared<const SparseMap>(map_);
    const TrackResult& result = report->result;
    poses_.push_back({.frame = now.frame->index,
                      .time = now.frame->time,
                      .state = result.state,
                      .reference = result.reference,
                      .reference_from_camera = result.reference_from_camera,
                      .world_from_camera = result.world_from_camera});
    call("frame", i, [&] { stage_.frame(*report); });
  }

  // The first tracked frame becomes a key frame.
  void track(std::size_t i, TrackResult& result) {
    const Pose& world_from_camera = input(i).world_from_camera;
    if (reference_ == kNoId) {
      reference_ = static_cast<KeyFrameId>(map_.keyframe_id_end());
      result.keyframe = scenario_.keyframe(i, reference_);
      map_ = inserted(std::move(map_), *result.keyframe);
    }
    result.reference = reference_;
    result.reference_from_camera =
        map_.world_from_keyframe(reference_).inverse() * world_from_camera;
    result.world_from_camera = world_from_camera;
    result.uncertainty.emplace();
    result.tracked = {{{10, 10}, TrackedFeature::Use::kInlier},
                      {{20, 20}, TrackedFeature::Use::kMoving}};
  }

  SparseMap map_ = saved_map(scenario_);
  KeyFrameId reference_ = kNoId;
  std::vector<TrackedPose> poses_;
  SourceReport source_;
};

}  // namespace

template <>
std::unique_ptr<Drive> make_drive(Output& stage, const DriveSetup& setup) {
  return std::make_unique<OutputDrive>(stage, setup);
}

}  // namespace stillpoint::plugin_check
