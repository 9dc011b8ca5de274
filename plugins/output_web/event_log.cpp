#include "output_web/event_log.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "output_web/json_text.hpp"
#include "output_web/message_writer.hpp"
#include "output_web/picture.hpp"

namespace stillpoint::output_web {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kTimesKept = 12'000;  // about 600 frames
constexpr std::size_t kCloudsKept = 2000;
constexpr std::size_t kFirstFit = 10;  // frames
constexpr double kFitGrowth = 1.05;    // of the frames, until the truth is fitted again
constexpr double kNoShift = 1e-4;      // metres

// A viewer says nothing while a message comes, and is taken for gone after half a minute of that.
// Over half a megabit per second, all of this and an image come within a third of it.
constexpr std::size_t kFramesPerMessage = 700;         // 92 bytes each
constexpr std::size_t kTimesPerMessage = 6000;         // 9 bytes each
constexpr std::size_t kMapBytesPerMessage = 128'000;   // and the rest of one element
constexpr std::size_t kCloudBytesPerMessage = 80'000;  // likewise; 29 kB each for 640 × 480 px
constexpr std::size_t kVoxelsPerMessage = 12'000;      // 17 bytes each

void write_text(Record kind, const std::string& text, MessageWriter& writer) {
  writer.begin(kind);
  writer.text(text);
  writer.end();
}

/// At most `most` elements from `first` on, which is then the first that is left.
template <class List>
std::vector<typename List::value_type> next_part(const List& list, std::size_t& first,
                                                 std::size_t most) {
  const auto begin = list.begin() + static_cast<std::ptrdiff_t>(first);
  const std::size_t count = std::min(list.size() - first, most);
  first += count;
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

struct EventLog::Snapshot {
  FrameReport latest;
  std::vector<FrameEntry> frames;
  std::vector<FrameEntry> fit;  // of the truth: to all frames; empty: it is new enough
  std::vector<std::string> stages;
  std::size_t first_stage = 0;
  std::vector<TimeEntry> times;
  std::vector<std::shared_ptr<const std::string>> clouds;
  std::vector<LoopEntry> loops;
  std::string steering;
  MapPtr map;        // null: nothing new
  VoxelsPtr voxels;  // likewise
  std::string end;

  bool empty() const {
    return frames.empty() && times.empty() && clouds.empty() && steering.empty() && !map &&
           !voxels && end.empty();
  }
};

void EventLog::add(const FrameReport& report) {
  const TrackResult& result = report.result;
  FrameEntry entry{.pose = {.frame = report.frame->index,
                            .time = report.frame->time,
                            .state = result.state,
                            .reference = result.reference,
                            .reference_from_camera = result.reference_from_camera,
                            .world_from_camera = result.world_from_camera,
                            .depth_registered = result.depth_registered},
                   .features = result.features,
                   .matches = result.matches,
                   .inliers = result.inliers,
                   .keyframe = result.keyframe.has_value(),
                   .true_position = run_.truth.position_at(report.frame->time)};
  entry.pose.poorly_constrained = result.state == TrackState::kTracking && result.uncertainty &&
                                  result.uncertainty->poorly_constrained();
  std::shared_ptr<const std::string> cloud;
  if (result.keyframe)
    cloud = std::make_shared<const std::string>(cloud_of(report, result.keyframe->id));
  const std::lock_guard lock(mutex_);
  add_loop(report);
  add_times(report.times);
  frames_.push_back(std::move(entry));
  if (cloud) clouds_.push_back(std::move(cloud));
  if (clouds_.size() > kCloudsKept) {
    clouds_.pop_front();
    ++clouds_dropped_;
  }
  latest_ = report;
}

void EventLog::set_steering(std::string state) {
  const std::lock_guard lock(mutex_);
  steering_ = std::move(state);
  ++steering_changes_;
}

bool EventLog::shows_voxels() const {
  const std::lock_guard lock(mutex_);
  return voxels_ != nullptr;
}

void EventLog::set_voxels(VoxelsPtr voxels) {
  const std::lock_guard lock(mutex_);
  voxels_ = std::move(voxels);
}

void EventLog::add_times(const std::vector<StageTime>& times) {
  for (const StageTime& time : times) {
    auto stage = std::ranges::find(stages_, time.stage);
    if (stage == stages_.end()) stage = stages_.insert(stages_.end(), time.stage);
    times_.push_back({time.frame, static_cast<std::uint8_t>(stage - stages_.begin()),
                      static_cast<float>(time.wall_ms)});
  }
  while (times_.size() > kTimesKept) {
    times_.pop_front();
    ++times_dropped_;
  }
}

// Compares with the map before: what mapping has moved meanwhile is among it.
void EventLog::add_loop(const FrameReport& report) {
  if (!latest_.map || !report.map || report.loops_closed == latest_.loops_closed) return;
  LoopEntry loop{.frame = report.frame->index,
                 .count = static_cast<std::uint32_t>(report.loops_closed - latest_.loops_closed)};
  for (KeyFrameId id = 0; id < latest_.map->keyframe_id_end(); ++id) {
    const KeyFrame* before = latest_.map->keyframe(id);
    const KeyFrame* after = report.map->keyframe(id);
    if (!before || !after) continue;
    const double shift =
        (after->world_from_camera.translation() - before->world_from_camera.translation()).norm();
    if (shift > kNoShift) ++loop.moved;
    loop.largest_shift_m = std::max(loop.largest_shift_m, static_cast<float>(shift));
  }
  loops_.push_back(loop);
}

void EventLog::finish(const RunSummary& summary) {
  const Json json = {{"complete", summary.complete},
                     {"failure", summary.failure},
                     {"dropped_frames", summary.dropped_frames},
                     {"source_skipped", summary.source.skipped},
                     {"loops_closed", summary.loops_closed},
                     {"wall_seconds", summary.wall_seconds}};
  if (shows_voxels()) set_voxels(sorted_voxels(summary.dense_map()));
  const std::lock_guard lock(mutex_);
  add_times(summary.times);
  latest_.map = std::make_shared<const SparseMap>(summary.map);
  end_ = text_of(json);
}

std::string EventLog::news(Seen& seen, const Request& request) {
  const Snapshot now = snapshot(seen, request);
  if (now.empty()) return {};
  MessageWriter writer;
  writer.number(kProtocol);
  if (!seen.run_info && now.latest.frame) {
    write_text(Record::kRunInfo, run_info(*now.latest.frame->camera), writer);
    seen.run_info = true;
  }
  write_stages(now.stages, now.first_stage, writer);
  if (now.map) write_map_changes(seen.map, now.map, kMapBytesPerMessage, writer);
  write_frames(now.frames, writer);
  if (now.latest.left_out != seen.left_out) {
    write_left_out(now.latest.left_out, writer);
    seen.left_out = now.latest.left_out;
  }
  write_times(now.times, writer);
  for (const auto& cloud : now.clouds) writer.text(*cloud);
  if (now.voxels)
    seen.voxels = write_voxel_changes(seen.voxels, now.voxels, kVoxelsPerMessage, writer);
  write_loops(now.loops, writer);
  if (!now.fit.empty() && now.latest.map) write_fit(now.fit, *now.latest.map, writer);
  if (request.image && now.latest.frame && seen.image != now.latest.frame->index) {
    writer.text(picture(now.latest));
    seen.image = now.latest.frame->index;
  }
  if (!now.steering.empty()) write_text(Record::kSteering, now.steering, writer);
  if (!now.end.empty()) write_text(Record::kEnd, now.end, writer);
  return writer.take();
}

EventLog::Snapshot EventLog::snapshot(Seen& seen, const Request& request) const {
  const std::lock_guard lock(mutex_);
  Snapshot now{.latest = latest_, .first_stage = seen.stages};
  now.stages = next_part(stages_, seen.stages, stages_.size());

  const auto grown = static_cast<std::size_t>(kFitGrowth * static_cast<double>(seen.fitted_frames));
  if (run_.truth.known() && frames_.size() >= std::max(kFirstFit, grown + 1)) {
    now.fit = frames_;
    seen.fitted_frames = frames_.size();
  }
  now.frames = next_part(frames_, seen.frames, kFramesPerMessage);
  std::size_t times = std::max(seen.times, times_dropped_) - times_dropped_;
  now.times = next_part(times_, times, kTimesPerMessage);
  seen.times = times_dropped_ + times;
  now.loops = next_part(loops_, seen.loops, loops_.size());

  seen.clouds = std::max(seen.clouds, clouds_dropped_);
  std::size_t bytes = 0;
  for (std::size_t i = seen.clouds - clouds_dropped_;
       request.cloud && i < clouds_.size() && bytes < kCloudBytesPerMessage; ++i) {
    now.clouds.push_back(clouds_[i]);
    bytes += clouds_[i]->size();
  }
  seen.clouds += now.clouds.size();
  if (seen.steering != steering_changes_) now.steering = steering_;
  seen.steering = steering_changes_;
  if (request.map && latest_.map && seen.map.whole != latest_.map) now.map = latest_.map;
  if (request.voxels && voxels_ && seen.voxels != voxels_) now.voxels = voxels_;
  if (!seen.end && seen.frames == frames_.size()) {
    now.end = end_;
    seen.end = !end_.empty();
  }
  return now;
}

std::string EventLog::run_info(const Camera& camera) const {
  Json classes = Json::array();
  for (std::size_t id = 0; id < run_.classes.size(); ++id)
    classes.push_back(
        {{"name", run_.classes[id]}, {"color", color_of_class(static_cast<std::uint8_t>(id))}});
  return text_of({{"version", STILLPOINT_VERSION},
                  {"run", run_.name},
                  {"truth", run_.truth.known()},
                  {"camera",
                   {{"width", camera.width},
                    {"height", camera.height},
                    {"fx", camera.fx},
                    {"fy", camera.fy},
                    {"cx", camera.cx},
                    {"cy", camera.cy}}},
                  {"classes", classes}});
}

const std::string& EventLog::picture(const FrameReport& report) {
  if (picture_frame_ != report.frame->index) {
    picture_ = picture_of(report);
    picture_frame_ = report.frame->index;
  }
  return picture_;
}

}  // namespace stillpoint::output_web
