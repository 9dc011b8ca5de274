#include "session.hpp"

#include <stillpoint/engine/engine.hpp>
#include <stillpoint/engine/map_file.hpp>
#include <stillpoint/support/option_check.hpp>
#include <stillpoint/support/rectifier.hpp>
#include <stillpoint/support/trajectory.hpp>
#include <utility>

namespace stillpoint_ros {
namespace {

using stillpoint::Engine;
using stillpoint::Error;
using stillpoint::Fault;
using stillpoint::LogLevel;
using stillpoint::SparseMap;

std::string size_of(const SparseMap& map) {
  return std::to_string(map.keyframe_count()) + " key frames and " +
         std::to_string(map.landmark_count()) + " landmarks";
}

TrackedFrame::State state_of(stillpoint::TrackState state) {
  switch (state) {
    case stillpoint::TrackState::kTracking:
      return TrackedFrame::State::kTracking;
    case stillpoint::TrackState::kLost:
      return TrackedFrame::State::kLost;
    case stillpoint::TrackState::kWaiting:
      break;
  }
  return TrackedFrame::State::kWaiting;
}

TrackedFrame tracked_frame(const stillpoint::FrameReport& report) {
  const stillpoint::TrackResult& result = report.result;
  TrackedFrame frame{.state = state_of(result.state),
                     .index = report.frame->index,
                     .world_from_camera = result.world_from_camera,
                     .inliers = result.inliers,
                     .keyframes = report.map->keyframe_count(),
                     .landmarks = report.map->landmark_count(),
                     .loops_closed = report.loops_closed};
  if (result.uncertainty) {
    frame.covariance = result.uncertainty->covariance;
    frame.poorly_constrained = result.uncertainty->poorly_constrained();
  }
  return frame;
}

/// In what CameraInfo says; the rest are parameters of the node.
bool is_same(const SensorCamera& a, const SensorCamera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion;
}

std::string size_of(const SensorCamera& camera) {
  return std::to_string(camera.width) + " x " + std::to_string(camera.height) + " pixels";
}

stillpoint::CameraModel model_of(const SensorCamera& camera) {
  return {.name = "CameraInfo",
          .width = camera.width,
          .height = camera.height,
          .fx = camera.fx,
          .fy = camera.fy,
          .cx = camera.cx,
          .cy = camera.cy,
          .distortion = camera.distortion,
          .depth_factor = camera.depth_factor,
          .min_depth = camera.min_depth,
          .max_depth = camera.max_depth,
          .depth_noise = camera.depth_noise,
          .surface_noise = camera.surface_noise};
}

}  // namespace

Session::Session(SessionOptions options, const std::filesystem::path& map_file)
    : options_(std::move(options)) {
  begin(map_file.empty() ? SparseMap() : stillpoint::load_map(map_file));
}

void Session::take_camera(const SensorCamera& camera) {
  if (rectifier_ && is_same(camera, camera_)) return;
  if (!last_time_) {
    const stillpoint::CameraModel model = model_of(camera);
    stillpoint::check_options(model, "the camera of CameraInfo");
    rectifier_ = std::make_shared<const stillpoint::Rectifier>(model);
    camera_ = camera;
    return;
  }
  const std::string remedy = "the service reset begins anew with it";
  if (camera.width != camera_.width || camera.height != camera_.height)
    throw Error(Fault::kData,
                "now has " + size_of(camera) + ", but the map was begun with " + size_of(camera_),
                "CameraInfo", remedy);
  options_.warn("CameraInfo is another one than at the first image, which stays in use; " + remedy);
}

std::optional<TrackedFrame> Session::process(const SensorImages& images,
                                             const SensorCamera& camera) {
  const std::lock_guard lock(mutex_);
  if (last_time_ && images.time <= *last_time_) return std::nullopt;
  take_camera(camera);
  stillpoint::Frame frame = rectifier_->frame(images.time, images.bgr, images.depth);
  last_time_ = images.time;
  return tracked_frame(*engine_->process(std::move(frame)));
}

std::string Session::save_map(const std::filesystem::path& file) const {
  const auto map = engine()->map();
  if (map->empty()) throw Error(Fault::kUsage, "there is no map yet, so nothing was saved");
  stillpoint::save_map(*map, file);
  return size_of(*map) + " saved in " + file.string();
}

std::string Session::load_map(const std::filesystem::path& file) {
  SparseMap map = stillpoint::load_map(file);
  const std::string size = size_of(map);
  begin(std::move(map));
  return size + " loaded from " + file.string();
}

std::string Session::reset() {
  begin({});
  return "begun anew, without a map";
}

// As Engine::trajectory(), but that only the copy of the poses makes tracking wait.
std::vector<stillpoint::StampedPose> Session::trajectory() const {
  std::shared_ptr<const Engine> engine;
  std::vector<stillpoint::TrackedPose> poses;
  {
    const std::lock_guard lock(mutex_);
    engine = engine_;
    poses = engine->poses();
  }
  const auto map = engine->map();
  std::vector<stillpoint::StampedPose> trajectory;
  for (const stillpoint::TrackedPose& pose : poses)
    if (const auto in_world = stillpoint::world_from_camera(*map, pose))
      trajectory.push_back({pose.time, *in_world});
  return trajectory;
}

std::vector<Eigen::Vector3f> Session::landmarks() const {
  const auto map = engine()->map();
  std::vector<Eigen::Vector3f> positions;
  for (stillpoint::LandmarkId id = 0; id < map->landmark_id_end(); ++id)
    if (const stillpoint::Landmark* landmark = map->landmark(id))
      positions.push_back(landmark->position_in_world.cast<float>());
  return positions;
}

std::vector<stillpoint::LabelledPoint> Session::dense_map() const { return engine()->dense_map(); }

bool Session::save_dense_map(const std::filesystem::path& directory) const {
  return engine()->save_dense_map(directory);
}

void Session::begin(SparseMap known_map) {
  auto engine = std::make_shared<Engine>(stillpoint::EngineSetup{
      .request = {.pipeline = options_.pipeline, .assignments = options_.set, .pushed = true},
      .known_map = std::move(known_map),
      .localise_only = options_.localise_only,
      .log = [warn = options_.warn](LogLevel level, std::string_view text) {
        if (level >= LogLevel::kWarning) warn(std::string(text));
      }});
  const std::lock_guard lock(mutex_);
  engine_.swap(engine);  // the old one ends when the lock is gone: its threads may take a while
  last_time_.reset();
}

std::shared_ptr<const Engine> Session::engine() const {
  const std::lock_guard lock(mutex_);
  return engine_;
}

}  // namespace stillpoint_ros
