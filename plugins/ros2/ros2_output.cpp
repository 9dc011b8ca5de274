#include "ros2/ros2_output.hpp"

#include <cmath>
#include <utility>

#include "ros2_messages/point_clouds.hpp"

namespace stillpoint::ros2 {
namespace {

using ros2_messages::Diagnosis;
using ros2_messages::Mounting;

constexpr std::chrono::seconds kLastPatience(2);             // at the end, for the readers' answers
constexpr std::chrono::milliseconds kOdometryPatience(100);  // it may come later than the images

Ros2Output::Options checked(const Ros2Output::Options& options) {
  const bool asks_tf = !options.camera_frame.empty() || !options.odom_frame.empty();
  if (asks_tf && options.base_frame == ros2_messages::kCameraFrame)
    throw Error(Fault::kUsage, "is needed with camera_frame or odom_frame", "base_frame",
                "name the robot's, such as base_link");
  if (!options.camera_frame.empty() && !options.base_from_camera.empty())
    throw Error(Fault::kUsage, "is what tf is asked for with camera_frame", "base_from_camera",
                "give one of both");
  if (!options.odom_frame.empty() && options.camera_frame.empty() &&
      options.base_from_camera.empty())
    throw Error(Fault::kUsage, "needs to know where the camera is on the base", "odom_frame",
                "give camera_frame, for which tf is asked, or base_from_camera");
  return options;
}

Mounting mounting_of(const Ros2Output::Options& options) {
  Mounting mounting{.map = options.map_frame, .base = options.base_frame};
  const std::vector<double>& numbers = options.base_from_camera;
  if (numbers.empty()) return mounting;
  const bool seven = numbers.size() == 7;
  const Eigen::Quaterniond rotation =
      seven ? Eigen::Quaterniond(numbers[6], numbers[3], numbers[4], numbers[5])
            : Eigen::Quaterniond(0, 0, 0, 0);
  if (!(std::abs(rotation.norm() - 1) < 0.01))
    throw Error(Fault::kUsage, "needs x, y, z and a quaternion x, y, z, w of length 1",
                "base_from_camera",
                "'ros2 run tf2_ros tf2_echo BASE CAMERA' shows them, where tf knows both frames");
  mounting.base_from_camera = Pose(rotation.normalized());
  mounting.base_from_camera.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  mounting.map_from_world = mounting.base_from_camera;
  return mounting;
}

/// Every `period` seconds of the recording.
bool due(double& next, double time, double period) {
  if (time < next) return false;
  next = time + period;
  return true;
}

TrackedPose tracked_pose(const FrameReport& report) {
  const TrackResult& result = report.result;
  return {.frame = report.frame->index,
          .time = report.frame->time,
          .state = result.state,
          .reference = result.reference,
          .reference_from_camera = result.reference_from_camera,
          .world_from_camera = result.world_from_camera};
}

}  // namespace

void Ros2Output::Options::visit(OptionVisitor& v) {
  v("name", name, {.help = "namespace of all topics but /tf"});
  v("domain", domain,
    {.min = -1, .max = 232, .help = "DDS domain; -1: that of ROS_DOMAIN_ID, or 0"});
  v("map_frame", map_frame, {.help = "tf frame of the map: the base at the first frame"});
  v("base_frame", base_frame,
    {.help = "tf frame of the robot; without odom_frame it must have no parent in tf"});
  v("base_from_camera", base_from_camera,
    {.help = "x, y, z and quaternion x, y, z, w of the camera in the base; empty: the base is the "
             "camera, and the map has x where it looked, z up"});
  v("camera_frame", camera_frame,
    {.help = "tf frame of the images; its place on the base is then asked of tf, instead of "
             "base_from_camera"});
  v("odom_frame", odom_frame,
    {.help = "tf frame of the robot's odometry, the parent of the base; with it, map → odom is "
             "published instead of map → base, as REP 105 has it"});
  v("path_period", path_period,
    {.min = 0,
     .unit = "s",
     .help = "time between two messages of the topic path, which is sent while somebody subscribes "
             "it; smaller: more network traffic"});
  v("map_period", map_period,
    {.min = 0,
     .unit = "s",
     .help = "time between two messages of each of the map topics landmarks, dense_map, octomap "
             "and grid; smaller: more network traffic and processor time"});
}

Ros2Output::Ros2Output(const Options& options, const StageContext& context)
    : options_(checked(options)),
      may_save_meanwhile_(!context.deterministic),
      log_(context.log),
      participant_(options.domain),
      topics_([&] {
        const auto writer = [&](const char* name, const char* type, Kept kept) {
          return Writer(participant_, options.name + name, type, kept);
        };
        return Topics{
            .transform =
                Writer(participant_, "/tf", ros2_messages::Transform::kType, Kept::kShortly),
            .static_transform =
                Writer(participant_, "/tf_static", ros2_messages::Transform::kType, Kept::kLast),
            .odometry = writer("/odom", ros2_messages::Odometry::kType, Kept::kShortly),
            .pose = writer("/pose", ros2_messages::PoseMessage::kType, Kept::kShortly),
            .state = writer("/state", Diagnosis::kType, Kept::kLast),
            .path = writer("/path", ros2_messages::Path::kType, Kept::kLast),
            .landmarks = writer("/landmarks", ros2_messages::PointCloud::kType, Kept::kLast),
            .dense_map = writer("/dense_map", ros2_messages::PointCloud::kType, Kept::kLast),
            .octomap = writer("/octomap", ros2_messages::Octree::kType, Kept::kLast),
            .grid = writer("/grid", ros2_messages::OccupancyGrid::kType, Kept::kLast)};
      }()) {
  if (!options.camera_frame.empty() || !options.odom_frame.empty()) tf_.emplace(participant_);
  if (options.camera_frame.empty()) mount(mounting_of(options));
}

std::string Ros2Output::world_frame() const { return options_.map_frame + "_optical"; }

void Ros2Output::mount(Mounting mounting) {
  ros2_messages::Transform world;
  world.header.frame = mounting.map;
  world.child = world_frame();
  world.header_from_child = mounting.map_from_world;
  publish(topics_.static_transform, world);
  sequence_.emplace(mounting);
  mounting_ = std::move(mounting);
}

/// tf is asked until it knows where the camera is.
bool Ros2Output::is_mounted() {
  if (mounting_) return true;
  const auto base_from_camera =
      tf_->target_from_source(options_.base_frame, options_.camera_frame, {}, {});
  if (base_from_camera)
    mount({.map = options_.map_frame,
           .base = options_.base_frame,
           .map_from_world = *base_from_camera,
           .base_from_camera = *base_from_camera});
  else if (!std::exchange(has_warned_of_camera_, true))
    log_(LogLevel::kWarning, "tf does not know " + options_.camera_frame + " in " +
                                 options_.base_frame +
                                 ": until it does, only the state is published");
  return mounting_.has_value();
}

template <class Message>
void Ros2Output::publish(const Writer& topic, const Message& message) {
  if (!topic.write(cdr_of(message))) ++refused_;
}

void Ros2Output::begin(const std::shared_ptr<LiveRun>& run) {
  run_ = run;
  if (may_save_meanwhile_) dense_files_.emplace(run, options_.map_period);
}

void Ros2Output::frame(const FrameReport& report) {
  const double time = report.frame->time;
  poses_.push_back(tracked_pose(report));
  publish_state(report);
  if (!is_mounted()) return;
  if (const auto messages = sequence_->next(time, report.result)) {
    publish_transform(messages->transform);
    publish(topics_.odometry, messages->odometry);
    publish(topics_.pose, messages->pose);
  }
  if (topics_.path.wanted() && due(next_path_, time, options_.path_period))
    publish_path(*report.map, poses_, time);
  if (topics_.landmarks.wanted() && due(next_map_, time, options_.map_period))
    publish_landmarks(*report.map, time);
  if (run_ && topics_.dense_map.wanted() && time >= next_dense_map_)
    if (const auto points = run_->dense_map()) {  // or with the next frame
      publish(topics_.dense_map, ros2_messages::dense_cloud(*points, *mounting_, time));
      next_dense_map_ = time + options_.map_period;
    }
  if (dense_files_) publish_dense_files(time);
}

// A map that cannot be written is no reason to end the run.
void Ros2Output::publish_dense_files(double time) try {
  if (auto files = dense_files_->next(time, dense_files_wanted())) publish(std::move(*files));
} catch (const std::exception& error) {
  if (!std::exchange(has_warned_, true))
    log_(LogLevel::kWarning,
         std::string("octomap and grid cannot be published now: ") + error.what());
}

void Ros2Output::publish_transform(const ros2_messages::Transform& map_from_base) {
  if (options_.odom_frame.empty()) return publish(topics_.transform, map_from_base);
  const auto odom_from_base = tf_->target_from_source(options_.odom_frame, options_.base_frame,
                                                      map_from_base.header.time, kOdometryPatience);
  if (!odom_from_base) {
    if (frames_without_odometry_++ == 0)
      log_(LogLevel::kWarning, "tf does not know " + options_.base_frame + " in " +
                                   options_.odom_frame + " at the time of an image: map → " +
                                   options_.odom_frame + " is left out");
    return;
  }
  ros2_messages::Transform map_from_odom = map_from_base;
  map_from_odom.child = options_.odom_frame;
  map_from_odom.header_from_child = map_from_base.header_from_child * odom_from_base->inverse();
  publish(topics_.transform, map_from_odom);
}

void Ros2Output::publish_state(const FrameReport& report) {
  const TrackResult& result = report.result;
  const bool tracking = result.state == TrackState::kTracking;
  const bool lost = result.state == TrackState::kLost;
  Diagnosis state{.level = tracking ? Diagnosis::Level::kOk : Diagnosis::Level::kWarning,
                  .name = options_.name,
                  .message = lost ? "lost" : name_of(result.state)};
  state.values = {{"frame", std::to_string(report.frame->index)},
                  {"dropped", std::to_string(report.left_out)},
                  {"inliers", std::to_string(result.inliers)},
                  {"loops_closed", std::to_string(report.loops_closed)}};
  if (tracking && result.uncertainty)
    state.values.emplace_back("poorly_constrained",
                              result.uncertainty->poorly_constrained() ? "true" : "false");
  publish(topics_.state, state);
}

void Ros2Output::publish_path(const SparseMap& map, const std::vector<TrackedPose>& poses,
                              double time) {
  publish(topics_.path, ros2_messages::path_of(map, poses, *mounting_, time));
}

void Ros2Output::publish_landmarks(const SparseMap& map, double time) {
  publish(topics_.landmarks, ros2_messages::landmark_cloud(map, *mounting_, time));
}

void Ros2Output::finish(const RunSummary& summary) {
  run_.reset();
  dense_files_.reset();
  if (!summary.failure.empty())
    publish(topics_.state, Diagnosis{.level = Diagnosis::Level::kError,
                                     .name = options_.name,
                                     .message = summary.failure});
  if (!summary.poses.empty() && mounting_) {
    const double time = summary.poses.back().time;
    if (topics_.path.wanted()) publish_path(summary.map, summary.poses, time);
    if (topics_.landmarks.wanted()) publish_landmarks(summary.map, time);
    if (topics_.dense_map.wanted())
      if (const auto points = summary.dense_map(); !points.empty())
        publish(topics_.dense_map, ros2_messages::dense_cloud(points, *mounting_, time));
    publish(read_dense_files(summary.map_directory, dense_files_wanted(), time));
  }
  wait_for_readers();
  if (frames_without_odometry_ > 1)
    log_(LogLevel::kWarning, "tf did not know " + options_.base_frame + " in " +
                                 options_.odom_frame + " at the time of " +
                                 std::to_string(frames_without_odometry_) + " images");
  if (refused_ > 0)
    log_(LogLevel::kWarning,
         "a reader was too slow: " + std::to_string(refused_) + " messages could not be published");
}

DenseFilesWanted Ros2Output::dense_files_wanted() const {
  return {.octree = topics_.octomap.wanted(), .grid = topics_.grid.wanted()};
}

void Ros2Output::publish(DenseFiles files) {
  if (files.octree) {
    files.octree->header = {files.time, world_frame()};
    publish(topics_.octomap, *files.octree);
  }
  if (files.grid) {
    files.grid->header = {files.time, mounting_->map};
    files.grid->header_from_origin = mounting_->map_from_world * files.grid->header_from_origin;
    publish(topics_.grid, *files.grid);
  }
}

/// What is still on its way is lost when the process ends.
void Ros2Output::wait_for_readers() const {
  using std::chrono::steady_clock;
  const auto deadline = steady_clock::now() + kLastPatience;
  for (const Writer* topic :
       {&topics_.transform, &topics_.odometry, &topics_.pose, &topics_.state, &topics_.path,
        &topics_.landmarks, &topics_.dense_map, &topics_.octomap, &topics_.grid})
    topic->wait_for_readers(
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now()));
}

}  // namespace stillpoint::ros2
