#include "stillpoint/runtime/mapping_system.hpp"

#include <exception>
#include <utility>

#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/runtime/mapping_results.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint {
namespace {

constexpr std::size_t kKeyFramesWaiting = 3;
constexpr std::size_t kQueriesWaiting = 16;
constexpr std::size_t kDenseWaiting = 16;

// Removed key frames included: the dense map keeps what they have seen.
std::vector<MovedKeyFrame> moved_keyframes(const SparseMap& before, const SparseMap& after) {
  std::vector<MovedKeyFrame> moved;
  for (KeyFrameId id = before.keyframe_id_begin(); id < before.keyframe_id_end(); ++id) {
    if (before.keyframe(id) && before.keyframe(id) == after.keyframe(id)) continue;
    const Pose pose = after.world_from_keyframe(id);
    if (pose.matrix() != before.world_from_keyframe(id).matrix()) moved.push_back({id, pose});
  }
  return moved;
}

std::vector<LabelledPoint> occupied(const MapBackend& backend) {
  std::vector<LabelledPoint> points = backend.occupied();
  check_points(points);
  return points;
}

SparseMap insert(LocalMapper& mapper, const SparseMap& before, KeyFrame keyframe, bool thorough) {
  SparseMap map = mapper.insert(before, std::move(keyframe));
  check_inserted(map, before);
  if (thorough) check_thoroughly(map);
  return map;
}

SparseMap refine(LocalMapper& mapper, const SparseMap& before, KeyFrameId keyframe,
                 std::stop_token end_early, bool thorough) {
  SparseMap map = mapper.refine(before, keyframe, std::move(end_early));
  check_refined(map, before);
  if (thorough) check_thoroughly(map);
  return map;
}

std::optional<MapCorrection> closure(LoopCloser& closer, const SparseMap& map, KeyFrameId latest,
                                     std::stop_token stop) {
  auto correction = closer.close(map, latest, std::move(stop));
  if (correction) check_correction(*correction, map);
  return correction;
}

std::optional<MapCorrection> adjustment(LoopCloser& closer, const SparseMap& map,
                                        std::stop_token end_early) {
  auto correction = closer.adjust(map, std::move(end_early));
  if (correction) check_correction(*correction, map);
  return correction;
}

}  // namespace

MappingSystem::MappingSystem(Stage<LocalMapper> local_mapper, Stage<LoopCloser> loop_closer,
                             Stage<MapBackend> map_backend, SparseMap known_map,
                             const RuntimeOptions& options, StopSignal& stop, TimeLog& times)
    : threaded_(options.mode == Mode::kThreaded),
      thorough_(options.validates_fully()),
      stop_(stop),
      local_mapper_(std::move(local_mapper), "local mapping", times),
      loop_closer_(std::move(loop_closer), "loop closing", times),
      map_backend_(std::move(map_backend), "dense mapping", times),
      map_(std::move(known_map)),
      next_keyframe_(static_cast<KeyFrameId>(snapshot()->keyframe_id_end())),
      local_mapping_(
          options.mode, kKeyFramesWaiting, stop,
          [this](MappingItem item) {
            if (auto* keyframe = std::get_if<NewKeyFrame>(&item))
              map(std::move(*keyframe));
            else if (const auto* correction = std::get_if<Correction>(&item))
              correct(*correction);
            else
              clear_maps();
          },
          ThreadPriority::kMapping),
      loop_closing_(
          loop_closer_.present() ? options.mode : Mode::kInline, kQueriesWaiting, stop,
          [this](const LoopItem& item) {
            if (const auto* query = std::get_if<std::shared_ptr<const LoopQuery>>(&item))
              close_loop(**query);
            else
              adjust(std::get<AdjustRequest>(item));
          },
          ThreadPriority::kBackground),
      dense_mapping_(
          map_backend_.present() ? options.mode : Mode::kInline, kDenseWaiting, stop,
          [this](const DenseItem& item) { map_densely(item); }, ThreadPriority::kBackground),
      ends_on_stop_(stop.token(), [this] {
        if (!threaded_) return;
        mapping_end_.request();
        adjustment_end_.request();
      }) {}

void MappingSystem::push(NewKeyFrame keyframe) {
  const bool first = snapshot()->empty();
  ++next_keyframe_;
  local_mapping_.push(std::move(keyframe));
  if (waiting()) mapping_end_.request();
  if (first) map_.wait_begun(stop_.token());
}

bool MappingSystem::clear() {
  mapping_end_.request();
  local_mapping_.push(Clear{});
  return local_mapping_.wait_idle() && snapshot()->empty();
}

void MappingSystem::end() {
  // Two rounds: local mapping sends loop queries, whose corrections come back to it. Then it asks
  // for an adjustment of the whole map, which comes back as well.
  for (int round = 0; round < 2; ++round) {
    local_mapping_.wait_idle();
    loop_closing_.wait_idle();
  }
  loop_closing_.end();
  local_mapping_.end();
  dense_mapping_.end();
}

std::vector<LabelledPoint> MappingSystem::dense_points() {
  const std::lock_guard lock(dense_mutex_);
  if (!map_backend_.usable()) return {};
  return map_backend_.call_unmeasured({}, occupied);
}

std::optional<std::vector<LabelledPoint>> MappingSystem::dense_points_if_idle() {
  const std::unique_lock lock(dense_mutex_, std::try_to_lock);
  if (!lock || !map_backend_.present() || !map_backend_.usable()) return std::nullopt;
  try {
    return map_backend_.call_unmeasured({}, occupied);
  } catch (...) {  // whoever asked may go on without it; a run cannot
    stop_.fail(std::current_exception());
    throw;
  }
}

bool MappingSystem::save(const std::filesystem::path& directory) {
  const std::lock_guard lock(dense_mutex_);
  if (!map_backend_.present() || !map_backend_.usable()) return false;
  save_locked(directory);
  return true;
}

bool MappingSystem::save_if_idle(const std::filesystem::path& directory) {
  const std::unique_lock lock(dense_mutex_, std::try_to_lock);
  if (!lock || !has_integrated_ || !map_backend_.usable()) return false;
  try {
    save_locked(directory);
  } catch (...) {  // without room for files a run can go on, but not after a crash
    if (StageGuard::has_ended_a_call()) stop_.fail(std::current_exception());
    throw;
  }
  return true;
}

void MappingSystem::save_locked(const std::filesystem::path& directory) {
  map_backend_.call_unmeasured({}, [&](MapBackend& backend) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error)
      throw Error(Fault::kUsage, "cannot be made: " + error.message(), directory.string(),
                  "choose another folder for the run");
    backend.save(directory);
  });
}

void MappingSystem::map(NewKeyFrame item) {
  const KeyFrameId id = item.keyframe.id;
  const std::uint32_t frame = item.keyframe.frame;
  const MapStore::Snapshot before = map_.snapshot();
  map_.publish(local_mapper_.call("map_insert", frame, insert, *before, std::move(item.keyframe),
                                  thorough_));
  map_.publish(local_mapper_.call("map_refine", frame, refine, *map_.snapshot(), id,
                                  mapping_end_.begin(threaded_ && (waiting() || stop_.requested())),
                                  thorough_));
  const MapStore::Snapshot after = map_.snapshot();
  send_moved(*before, *after);
  if (map_backend_.present() && id < after->keyframe_id_end()) {
    item.images.world_from_camera = after->world_from_keyframe(id);
    dense_mapping_.push(std::make_shared<const DenseKeyFrame>(std::move(item.images)));
  }
  if (loop_closing_.size() >= kQueriesWaiting / 2) adjustment_end_.request();
  // Last: inline, its correction is applied within.
  loop_closing_.push(std::make_shared<const LoopQuery>(LoopQuery{after, id, frame}));
}

void MappingSystem::correct(const Correction& item) {
  const MapStore::Snapshot before = map_.snapshot();
  const bool applies =
      item.correction.keyframe_id_end > before->keyframe_id_begin();  // not cleared
  if (applies) {
    map_.publish(loop_closer_.call("map_correct", item.frame, [&](LoopCloser&) {
      SparseMap map = apply(item.correction, *before);
      if (thorough_) check_thoroughly(map);
      return map;
    }));
    send_moved(*before, *map_.snapshot());
  }
  if (!item.closes_loop) return;
  if (applies) ++loops_;
  loop_closing_.push_past_limit(AdjustRequest{item.frame});
}

void MappingSystem::clear_maps() {
  MapEdit edit(*snapshot());
  edit.clear();
  map_.publish(std::move(edit).finish());
  if (map_backend_.present()) dense_mapping_.push(Clear{});
}

void MappingSystem::close_loop(const LoopQuery& query) {
  if (correction_pending_) return;
  auto correction =
      loop_closer_.call("loop", query.frame, closure, *query.map, query.keyframe, stop_.token());
  if (!correction) return;
  correction_pending_ = true;
  local_mapping_.push_past_limit(Correction{std::move(*correction), query.frame, true});
}

void MappingSystem::adjust(const AdjustRequest& request) {
  correction_pending_ = false;
  const MapStore::Snapshot map = map_.snapshot();
  if (map->empty()) return;
  auto correction = loop_closer_.call("loop_adjust", request.frame, adjustment, *map,
                                      adjustment_end_.begin(threaded_ && stop_.requested()));
  if (correction) local_mapping_.push_past_limit(Correction{std::move(*correction), request.frame});
}

void MappingSystem::map_densely(const DenseItem& item) {
  const std::lock_guard lock(dense_mutex_);
  if (!map_backend_.usable()) return;  // an output's thread had it read or saved
  if (const auto* keyframe = std::get_if<std::shared_ptr<const DenseKeyFrame>>(&item)) {
    dense_frame_ = (*keyframe)->frame->index;
    map_backend_.call("dense", dense_frame_, &MapBackend::integrate, **keyframe);
    has_integrated_ = true;
  } else if (const auto* moved = std::get_if<std::vector<MovedKeyFrame>>(&item)) {
    map_backend_.call("dense", dense_frame_, &MapBackend::move, *moved);
  } else {
    map_backend_.call("dense", dense_frame_, &MapBackend::clear);
    has_integrated_ = false;
  }
}

void MappingSystem::send_moved(const SparseMap& before, const SparseMap& after) {
  if (!map_backend_.present()) return;
  if (auto moved = moved_keyframes(before, after); !moved.empty())
    dense_mapping_.push(std::move(moved));
}

}  // namespace stillpoint
