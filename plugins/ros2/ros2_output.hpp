// What a run finds, published while it goes.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <string>
#include <vector>

#include "ros2/dense_files.hpp"
#include "ros2/participant.hpp"
#include "ros2/transform_listener.hpp"
#include "ros2_messages/mounting.hpp"
#include "ros2_messages/pose_messages.hpp"

namespace stillpoint::ros2 {

/// Of every frame tf, odometry, pose and state; from time to time and at the end, where somebody
/// reads them, path, landmarks, dense map, octree and occupancy grid. A reader that is too slow
/// loses messages.
class Ros2Output final : public Output {
 public:
  struct Options {
    std::string name = "stillpoint";  ///< before the names of all topics but /tf
    int domain = -1;                  ///< negative: that of ROS_DOMAIN_ID, or 0
    std::string map_frame = "map";
    std::string base_frame = ros2_messages::kCameraFrame;
    std::vector<double> base_from_camera;  ///< x, y, z, then quaternion x, y, z, w; empty: the base
                                           ///< is the camera
    std::string camera_frame;              ///< not empty: tf has it below the base
    std::string odom_frame;                ///< not empty: tf has it above the base
    double path_period = 1.0;              ///< seconds
    double map_period = 5.0;               ///< seconds

    void visit(OptionVisitor& visitor);
  };

  Ros2Output(const Options& options, const StageContext& context);

  void begin(const std::shared_ptr<LiveRun>& run) override;
  bool may_miss_frames() const override { return true; }
  void frame(const FrameReport& report) override;
  void finish(const RunSummary& summary) override;
  void ended_before_first_frame(const RunSummary& summary) override { finish(summary); }

 private:
  struct Topics {
    Writer transform, static_transform, odometry, pose, state, path, landmarks, dense_map, octomap,
        grid;
  };

  template <class Message>
  void publish(const Writer& topic, const Message& message);
  void mount(ros2_messages::Mounting mounting);
  bool is_mounted();
  void publish_transform(const ros2_messages::Transform& map_from_base);
  void publish_state(const FrameReport& report);
  void publish_path(const SparseMap& map, const std::vector<TrackedPose>& poses, double time);
  void publish_landmarks(const SparseMap& map, double time);
  DenseFilesWanted dense_files_wanted() const;
  void publish_dense_files(double time);
  void publish(DenseFiles files);
  void wait_for_readers() const;
  std::string world_frame() const;

  const Options options_;
  const bool may_save_meanwhile_;  // saving changes when the dense map is brought up to date
  std::function<void(LogLevel, std::string_view)> log_;
  Participant participant_;
  Topics topics_;
  std::optional<TransformListener> tf_;              // where tf is asked
  std::optional<ros2_messages::Mounting> mounting_;  // once it is known
  std::optional<ros2_messages::PoseSequence> sequence_;
  bool has_warned_of_camera_ = false;
  std::size_t frames_without_odometry_ = 0;
  std::shared_ptr<LiveRun> run_;
  std::optional<DenseFilesReader> dense_files_;
  bool has_warned_ = false;
  std::vector<TrackedPose> poses_;
  double next_path_ = 0, next_map_ = 0, next_dense_map_ = 0;  // seconds
  std::size_t refused_ = 0;                                   // messages
};

}  // namespace stillpoint::ros2
