// Stages that make or use maps: tracker, local mapper, loop closer, dense map; and outputs.
#include <algorithm>
#include <cmath>
#include <memory>
#include <stop_token>

#include "plugin_check/frame_drive.hpp"
#include "stillpoint/runtime/mapping_results.hpp"
#include "stillpoint/runtime/null_stages.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint::plugin_check {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFramesPerKeyFrame = 3;

/// As a pipeline without a local mapper does it.
SparseMap inserted(SparseMap map, KeyFrame keyframe) {
  return make_null_stage<LocalMapper>()->insert(std::move(map), std::move(keyframe));
}

std::stop_token requested_stop() {
  std::stop_source source;
  source.request_stop();
  return source.get_token();
}

void saw(Observer& observer, const SparseMap& map) {
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    observer.saw(map.world_from_keyframe(id));
  for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
    if (const Landmark* landmark = map.landmark(id)) observer.saw(landmark->position_in_world);
}

class TrackerDrive final : public FrameDrive<Tracker> {
 public:
  using FrameDrive::FrameDrive;

  std::string remark() const override {
    return "tracked " + std::to_string(tracked_) + " of " +
           std::to_string(scenario_.inputs.size()) + " frames, off by " +
           std::to_string(std::lround(1000 * worst_metres_)) + " mm at most";
  }

 private:
  void at(std::size_t i) override {
    const Input& now = input(i);
    auto prepared = call("prepare", i, [&] { return stage_.prepare(now.frame); });
    check("prepare", i, [&] { check_prepared(prepared.get(), *now.frame); });
    const TrackHints hints{
        .next_keyframe = static_cast<KeyFrameId>(map_.keyframe_id_end()),
        .localise_only = scenario_.localised_from && i >= *scenario_.localised_from};
    TrackResult result = call(
        "track", i, [&] { return stage_.track(std::move(prepared), *now.weights, map_, hints); });
    check("track", i, [&] {
      check_tracking(result, *now.frame, map_, hints);
      check_thoroughly(result);
    });
    observer_.saw(result.state);
    observer_.saw(result.world_from_camera);
    if (result.state == TrackState::kTracking) note_error(result, now);
    if (result.keyframe) map_ = inserted(std::move(map_), std::move(*result.keyframe));
  }

  // The first tracked camera is at the origin.
  void note_error(const TrackResult& result, const Input& now) {
    if (tracked_++ == 0) world_from_true_ = now.world_from_camera.inverse();
    const Pose truth = world_from_true_ * now.world_from_camera;
    worst_metres_ = std::max(worst_metres_,
                             (result.world_from_camera.translation() - truth.translation()).norm());
  }

  SparseMap map_;
  int tracked_ = 0;
  Pose world_from_true_ = Pose::Identity();
  double worst_metres_ = 0;
};

class LocalMapperDrive final : public FrameDrive<LocalMapper> {
 public:
  using FrameDrive::FrameDrive;

  std::string remark() const override {
    return std::to_string(map_.keyframe_count()) + " key frames, " +
           std::to_string(map_.landmark_count()) + " landmarks";
  }

 private:
  void at(std::size_t i) override {
    if (i % kFramesPerKeyFrame != 0) return;
    const auto id = static_cast<KeyFrameId>(map_.keyframe_id_end());
    KeyFrame keyframe = scenario_.keyframe(i, id);
    SparseMap map = call("insert", i, [&] { return stage_.insert(map_, std::move(keyframe)); });
    check("insert", i, [&] { check_inserted(map, map_); });
    require_consistent("insert", map);
    map_ = std::move(map);
    // Every second time another key frame waits already.
    const std::stop_token end_early = i % 2 == 0 ? std::stop_token() : requested_stop();
    map = call("refine", i, [&] { return stage_.refine(map_, id, end_early); });
    check("refine", i, [&] { check_refined(map, map_); });
    require_consistent("refine", map);
    map_ = std::move(map);
    saw(observer_, map_);
  }

  void require_consistent(const char* function, const SparseMap& map) {
    observer_.check(function, {}, [&] { check_thoroughly(map); });
    if (const auto fault = map.check())
      throw Failure({std::string(function) + "() gives an inconsistent map: " + *fault,
                     "tracking and loop closing follow these links",
                     "change maps with MapEdit, which keeps both sides of every link"});
  }

  SparseMap map_;
};

class LoopCloserDrive final : public FrameDrive<LoopCloser> {
 public:
  using FrameDrive::FrameDrive;

  std::string remark() const override { return std::to_string(closed_) + " loops closed"; }

 private:
  void at(std::size_t i) override {
    if (i % kFramesPerKeyFrame != 0) return;
    const auto id = static_cast<KeyFrameId>(map_.keyframe_id_end());
    map_ = inserted(std::move(map_), scenario_.keyframe(i, id));
    const std::stop_token stop = i % 2 == 0 ? std::stop_token() : requested_stop();
    const auto correction = call("close", i, [&] { return stage_.close(map_, id, stop); });
    if (!correction) return;
    ++closed_;
    correct("close", i, *correction);
    if (const auto adjusted = call("adjust", i, [&] { return stage_.adjust(map_, stop); }))
      correct("adjust", i, *adjusted);
  }

  void correct(const char* function, std::size_t i, const MapCorrection& correction) {
    check(function, i, [&] { check_correction(correction, map_); });
    map_ = apply(correction, std::move(map_));
    check(function, i, [&] { check_thoroughly(map_); });
    saw(observer_, map_);
  }

  SparseMap map_;
  int closed_ = 0;
};

class MapBackendDrive final : public FrameDrive<MapBackend> {
 public:
  using FrameDrive::FrameDrive;

  void finish() override {
    save();
    const auto points = observer_.call("occupied", {}, [&] { return stage_.occupied(); });
    for (const LabelledPoint& point : points) {
      require_right(point);
      observer_.saw(point.label);
    }
    observer_.saw(points.size());
    points_ = points.size();
    save();  // a map may be saved more than once
  }
  std::string remark() const override {
    return points_ > 0 ? std::to_string(points_) + " occupied cells" : "";
  }

 private:
  // Each new key frame moves those before a little, as bundle adjustment does.
  void at(std::size_t i) override {
    if (i % kFramesPerKeyFrame != 0) return;
    const DenseKeyFrame keyframe = scenario_.dense_keyframe(
        i, scenario_.first_keyframe + static_cast<KeyFrameId>(moved_.size()));
    call("integrate", i, [&] { stage_.integrate(keyframe); });
    for (MovedKeyFrame& moved : moved_) moved.world_from_camera.translation().x() += 0.02;
    call("move", i, [&] { stage_.move(moved_); });
    moved_.push_back({keyframe.id, keyframe.world_from_camera});
  }

  static void require_right(const LabelledPoint& point) {
    if (!point.position.allFinite())
      throw Failure({"a point of occupied() has no finite position",
                     "viewers and point clouds cannot place it", "leave out such points"});
    if (!(point.occupancy >= 0 && point.occupancy <= 1))
      throw Failure({"a point of occupied() has occupancy " + std::to_string(point.occupancy),
                     "viewers take it for a probability",
                     "give 0 to 1, or leave it at 1 where the map has none"});
  }

  void save() {
    observer_.call("save", {}, [&] { stage_.save(folder_); });
    bool wrote = false;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
      if (!entry.is_regular_file()) continue;
      wrote = true;
      if (entry.file_size() == 0)
        throw Failure({"save() wrote an empty file, " + entry.path().filename().string(),
                       "whoever opens it finds nothing", "leave out files that hold nothing"});
    }
    if (!wrote && scenario_.is_usual)
      throw Failure({"save() wrote no file, although key frames were integrated",
                     "a run ends with an empty folder for its dense map",
                     "write into the folder that save() is given, with commit() where the files "
                     "are AtomicFile"});
  }

  std::vector<MovedKeyFrame> moved_;
  std::size_t points_ = 0;
};

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
    TrackResult& result = report->result;
    result.state = i == 0       ? TrackState::kWaiting
                   : i % 5 == 3 ? TrackState::kLost
                                : TrackState::kTracking;
    if (result.state == TrackState::kTracking) {
      if (map_.empty()) {
        result.keyframe = scenario_.keyframe(i, 0);
        map_ = inserted({}, *result.keyframe);
      }
      result.reference = 0;
      result.reference_from_camera = map_.world_from_keyframe(0).inverse() * now.world_from_camera;
      result.world_from_camera = now.world_from_camera;
      result.uncertainty.emplace();
      result.tracked = {{{10, 10}, TrackedFeature::Use::kInlier},
                        {{20, 20}, TrackedFeature::Use::kMoving}};
    }
    report->map = std::make_shared<const SparseMap>(map_);
    poses_.push_back({.frame = now.frame->index,
                      .time = now.frame->time,
                      .state = result.state,
                      .reference = result.reference,
                      .reference_from_camera = result.reference_from_camera,
                      .world_from_camera = result.world_from_camera});
    call("frame", i, [&] { stage_.frame(*report); });
  }

  SparseMap map_;
  std::vector<TrackedPose> poses_;
  SourceReport source_;
};

}  // namespace

template <>
std::unique_ptr<Drive> make_drive(Tracker& stage, const DriveSetup& setup) {
  return std::make_unique<TrackerDrive>(stage, setup);
}
template <>
std::unique_ptr<Drive> make_drive(LocalMapper& stage, const DriveSetup& setup) {
  return std::make_unique<LocalMapperDrive>(stage, setup);
}
template <>
std::unique_ptr<Drive> make_drive(LoopCloser& stage, const DriveSetup& setup) {
  return std::make_unique<LoopCloserDrive>(stage, setup);
}
template <>
std::unique_ptr<Drive> make_drive(MapBackend& stage, const DriveSetup& setup) {
  return std::make_unique<MapBackendDrive>(stage, setup);
}
template <>
std::unique_ptr<Drive> make_drive(Output& stage, const DriveSetup& setup) {
  return std::make_unique<OutputDrive>(stage, setup);
}

}  // namespace stillpoint::plugin_check
