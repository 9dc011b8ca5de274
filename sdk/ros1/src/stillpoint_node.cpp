// The node `stillpoint`: images and depth of a camera in, poses and maps out. README.md has its
// topics.
#include <ros/ros.h>

#include <cstdio>
#include <mutex>
#include <set>
#include <stillpoint/error.hpp>
#include <thread>

#include "camera.hpp"
#include "frames.hpp"
#include "image_input.hpp"
#include "image_pixels.hpp"
#include "map_publisher.hpp"
#include "parameters.hpp"
#include "pose_publisher.hpp"
#include "services.hpp"
#include "session.hpp"

namespace stillpoint_ros {
namespace {

constexpr double kSilence = 2.0;        // seconds without images until ~state says so
constexpr double kSilencePeriod = 1.0;  // seconds from one such message to the next

/// What the engine says every time that a map is written is logged once.
class WarnOnce {
 public:
  void operator()(const std::string& text) {
    const std::lock_guard lock(said_->mutex);
    if (said_->texts.insert(text).second) ROS_WARN("%s", text.c_str());
  }

 private:
  struct Said {
    std::mutex mutex;
    std::set<std::string> texts;
  };
  std::shared_ptr<Said> said_ = std::make_shared<Said>();
};

SessionOptions session_options(SessionOptions options) {
  options.warn = WarnOnce();
  return options;
}

/// Threads: images and services, tracking, maps, and those of the engine.
class Node {
 public:
  Node(const ros::NodeHandle& node, const Parameters& parameters)
      : parameters_(parameters),
        session_(session_options(parameters.session),
                 parameters.load_map ? map_file(node) : std::filesystem::path()),
        frames_(parameters),
        poses_(node, frames_),
        maps_(node, session_, frames_, parameters.map_period),
        input_({}, parameters),
        services_(node, session_, input_),
        silence_timer_(node.createWallTimer(ros::WallDuration(kSilencePeriod),
                                            [this](const auto&) { tell_of_silence(); })) {}

  /// Until the node is shut down.
  void run() {
    ros::AsyncSpinner spinner(1);
    spinner.start();
    std::thread tracking([this] {
      while (const auto pair = input_.take()) track(*pair);
    });
    ros::waitForShutdown();
    input_.stop();
    tracking.join();
  }

 private:
  void track(const ImagePair& pair) try {
    const std_msgs::Header& header = pair.color->header;
    if (!frames_.find_mounting(header.frame_id)) return;
    const auto frame = session_.process(
        {header.stamp.toSec(), color_pixels(*pair.color), depth_pixels(*pair.depth)},
        camera_of(*pair.info, parameters_));
    if (frame)
      poses_.publish(*frame, header.stamp, input_.dropped());
    else
      ROS_WARN_THROTTLE(10,
                        "images that are not newer than the last are not used; the service "
                        "reset begins anew");
  } catch (const std::exception& error) {  // what was mapped can still be read and saved
    ROS_ERROR_THROTTLE(10, "%s", error.what());
    poses_.publish_failure(error.what());
  }

  // The state is latched: that of the last image would be there for ever.
  void tell_of_silence() {
    const double silence = input_.silence();
    if (silence >= kSilence) poses_.publish_silence(silence);
  }

  const Parameters parameters_;
  Session session_;
  Frames frames_;
  PosePublisher poses_;
  MapPublisher maps_;
  ImageInput input_;
  Services services_;
  ros::WallTimer silence_timer_;
};

}  // namespace
}  // namespace stillpoint_ros

int main(int argc, char** argv) try {
  ros::init(argc, argv, "stillpoint");
  const ros::NodeHandle node("~");
  stillpoint_ros::Node(node, stillpoint_ros::read_parameters(node)).run();
  return 0;
} catch (const stillpoint::Error& error) {
  std::fprintf(stderr, "stillpoint_node: %s\n", error.what());
  return error.exit_code();
} catch (const std::exception& error) {
  std::fprintf(stderr, "stillpoint_node: %s\n", error.what());
  return 1;
}
