// Stages that make maps: tracker, local mapper, dense map.
#include <algorithm>
#include <cmath>
#include <memory>
#include <stop_token>

#include "plugin_check/frame_drive.hpp"
#include "plugin_check/map_making.hpp"
#include "stillpoint/runtime/mapping_results.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint::plugin_check {
namespace {

namespace fs = std::filesystem;

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
    if (result.keyframe) insert(std::move(*result.keyframe));
  }

  // With large ids, most of those after the first have been removed.
  void insert(KeyFrame keyframe) {
    const bool is_first = map_.empty();
    map_ = inserted(std::move(map_), std::move(keyframe));
    if (is_first && scenario_.first_keyframe > 0)
      map_ = with_large_ids(std::move(map_), scenario_.first_keyframe - 1);
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

  SparseMap map_ = saved_map(scenario_);
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
    call("clear", scenario_.inputs.size() - 1, [&] { stage_.clear(); });
    const std::size_t left =
        observer_.call("occupied", {}, [&] { return stage_.occupied().size(); });
    if (left > 0)
      throw Failure({"clear() left " + std::to_string(left) + " occupied cells",
                     "a map that begins anew has its origin elsewhere: they would be ghosts",
                     "forget all that integrate() was given"});
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
std::unique_ptr<Drive> make_drive(MapBackend& stage, const DriveSetup& setup) {
  return std::make_unique<MapBackendDrive>(stage, setup);
}

}  // namespace stillpoint::plugin_check
