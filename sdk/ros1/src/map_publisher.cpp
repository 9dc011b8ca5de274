#include "map_publisher.hpp"

#include <nav_msgs/Path.h>
#include <ros/console.h>

#include "dense_map_files.hpp"
#include "point_clouds.hpp"
#include "pose_messages.hpp"

namespace stillpoint_ros {
namespace {

namespace fs = std::filesystem;

constexpr double kPathPeriod = 1.0;  // seconds
constexpr bool kLatch = true;

bool wanted(const ros::Publisher& publisher) { return publisher.getNumSubscribers() > 0; }

}  // namespace

MapPublisher::MapPublisher(ros::NodeHandle node, const Session& session, const Frames& frames,
                           double period_seconds)
    : session_(session),
      frames_(frames),
      path_(node.advertise<nav_msgs::Path>("path", 1, kLatch)),
      landmarks_(node.advertise<sensor_msgs::PointCloud2>("landmarks", 1, kLatch)),
      dense_map_(node.advertise<sensor_msgs::PointCloud2>("dense_map", 1, kLatch)),
      octomap_(node.advertise<octomap_msgs::Octomap>("octomap", 1, kLatch)),
      grid_(node.advertise<nav_msgs::OccupancyGrid>("grid", 1, kLatch)),
      spinner_(1, &queue_) {
  node.setCallbackQueue(&queue_);
  path_timer_ = node.createWallTimer(ros::WallDuration(kPathPeriod),
                                     [this](const auto&) { guarded([this] { publish_path(); }); });
  map_timer_ = node.createWallTimer(ros::WallDuration(period_seconds),
                                    [this](const auto&) { guarded([this] { publish_maps(); }); });
  spinner_.start();
}

MapPublisher::~MapPublisher() { spinner_.stop(); }

template <class Message>
void MapPublisher::publish(const ros::Publisher& publisher, Message message,
                           const std::string& frame) const {
  message.header.frame_id = frame;
  message.header.stamp = ros::Time::now();
  publisher.publish(message);
}

// A map that cannot be written is no reason to stop tracking.
template <class Step>
void MapPublisher::guarded(Step&& step) const {
  try {
    if (frames_.mounting()) step();
  } catch (const std::exception& error) {
    ROS_ERROR_THROTTLE(60, "%s", error.what());
  }
}

void MapPublisher::publish_path() const {
  if (!wanted(path_)) return;
  const Mounting mounting = *frames_.mounting();
  nav_msgs::Path path;
  for (const stillpoint::StampedPose& pose : session_.trajectory()) {
    geometry_msgs::PoseStamped stamped;
    stamped.header.frame_id = frames_.map();
    stamped.header.stamp = ros::Time(pose.time);
    stamped.pose = pose_message(mounting.map_from_base(pose.world_from_camera));
    path.poses.push_back(stamped);
  }
  publish(path_, std::move(path), frames_.map());
}

void MapPublisher::publish_maps() const {
  if (wanted(landmarks_))
    publish(landmarks_, landmark_cloud(session_.landmarks()), frames_.world());
  if (wanted(dense_map_)) publish(dense_map_, dense_cloud(session_.dense_map()), frames_.world());
  if (wanted(octomap_) || wanted(grid_)) publish_dense_files();
}

void MapPublisher::publish_dense_files() const {
  for (const auto& old : fs::directory_iterator(folder_.path())) fs::remove(old);
  session_.save_dense_map(folder_.path());
  if (const fs::path file = folder_.path() / "map.bt"; wanted(octomap_) && fs::exists(file))
    publish(octomap_, octomap_message(file), frames_.world());
  if (const fs::path file = folder_.path() / "map.yaml"; wanted(grid_) && fs::exists(file))
    publish(grid_, grid_message(file, frames_.mounting()->map_from_world), frames_.map());
}

}  // namespace stillpoint_ros
