#include "image_input.hpp"

#include <ros/console.h>

namespace stillpoint_ros {
namespace {

constexpr std::uint32_t kUnpaired = 30;  // images that may wait for the other of their pair

}  // namespace

ImageInput::ImageInput(ros::NodeHandle node, bool approximate, std::size_t queue_size)
    : queue_size_(queue_size),
      color_(node, "rgb/image_raw", kUnpaired),
      depth_(node, "depth_registered/image_raw", kUnpaired),
      info_subscriber_(node.subscribe<sensor_msgs::CameraInfo>(
          "rgb/camera_info", 1, [this](const sensor_msgs::CameraInfoConstPtr& info) {
            const std::lock_guard lock(mutex_);
            info_ = info;
            changed_.notify_one();
          })) {
  ROS_INFO("waiting for images on %s, %s and %s", color_.getTopic().c_str(),
           depth_.getTopic().c_str(), info_subscriber_.getTopic().c_str());
  if (approximate) {
    using Policy = message_filters::sync_policies::ApproximateTime<Image, Image>;
    approximate_ = std::make_unique<Approximate>(Policy(kUnpaired), color_, depth_);
    approximate_->registerCallback(&ImageInput::add, this);
  } else {
    using Policy = message_filters::sync_policies::ExactTime<Image, Image>;
    exact_ = std::make_unique<Exact>(Policy(kUnpaired), color_, depth_);
    exact_->registerCallback(&ImageInput::add, this);
  }
}

std::optional<ImagePair> ImageInput::take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopped_ || (info_ && !pairs_.empty()); });
  if (stopped_) return std::nullopt;
  ImagePair pair = std::move(pairs_.front());
  pair.info = info_;
  pairs_.pop_front();
  return pair;
}

void ImageInput::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

int ImageInput::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void ImageInput::add(const sensor_msgs::ImageConstPtr& color,
                     const sensor_msgs::ImageConstPtr& depth) {
  const std::lock_guard lock(mutex_);
  if (!info_)
    ROS_WARN_DELAYED_THROTTLE(10, "images come, but no CameraInfo on %s; they are not used",
                              info_subscriber_.getTopic().c_str());
  if (pairs_.size() == queue_size_) {
    pairs_.pop_front();
    ++dropped_;
  }
  pairs_.push_back({color, depth, nullptr});
  changed_.notify_one();
}

}  // namespace stillpoint_ros
